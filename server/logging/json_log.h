#ifndef BCCSKEL_SERVER_LOGGING_JSON_LOG_H_
#define BCCSKEL_SERVER_LOGGING_JSON_LOG_H_

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

// Structured logs: one JSON object a line on standard error, with time, level, event and the
// event's own fields.

namespace bccskel::server {

enum class LogLevel { kDebug = 1, kInfo, kWarning, kError };  // numbered as in spdlog

struct LogField {
  std::string_view name;
  std::variant<int64_t, double, std::string> value;
};

// While it lives, lines are written, by a thread of its own: nobody who logs ever waits for a slow
// reader of standard error. Of lines that come faster than they are read, the oldest are dropped;
// an event "log lines dropped" says how many. There is one at a time; without it nothing is logged.
// Its end writes what is left, for a second where nobody reads it.
class Logging {
 public:
  // `level` as on the command line: trace, debug, info, warning, error, off.
  explicit Logging(const std::string& level);
  ~Logging();
  Logging(const Logging&) = delete;
  Logging& operator=(const Logging&) = delete;

 private:
  class Writer;  // keeps spdlog out of this header
  std::unique_ptr<Writer> writer_;
};

void Log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields = {});

// From here on what gRPC and protobuf themselves have to say, such as a handshake that failed or a
// text that is not UTF-8, goes into the log as an event "grpc" or "protobuf". Left alone they write
// to standard error, and a call waits until somebody reads that. Called once.
void LogWhatLibrariesSay();

// Since the process began.
uint64_t DroppedLogLines();

// A JSON string with its quotes. Bytes that are not UTF-8 are replaced.
std::string JsonString(std::string_view text);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_LOGGING_JSON_LOG_H_
