#ifndef BCCSKEL_SERVER_LOGGING_JSON_LOG_H_
#define BCCSKEL_SERVER_LOGGING_JSON_LOG_H_

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

// Structured logs: one JSON object per line on standard error, with time, level, event and the
// event's own fields.

namespace bccskel::server {

enum class LogLevel { kDebug = 1, kInfo, kWarning, kError };  // numbered as in spdlog

struct LogField {
  std::string_view name;
  std::variant<int64_t, double, std::string> value;
};

// Writes log lines while it lives, on its own thread, so that logging never waits for a slow reader
// of standard error. If lines arrive faster than they are read, it drops the oldest; an event "log
// lines dropped" reports how many. At most one exists at a time; without one nothing is logged. The
// destructor writes the remaining lines, or gives up after a second if nobody reads them.
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

// From now on messages of gRPC and protobuf, such as a failed handshake or a text that is not
// UTF-8, go to the log as events "grpc" and "protobuf". Otherwise these libraries write to standard
// error, and a call waits until somebody reads that. Called once.
void LogLibraryMessages();

// Number of lines dropped since the process began.
uint64_t DroppedLogLines();

// A JSON string with its quotes. Bytes that are not UTF-8 are replaced.
std::string JsonString(std::string_view text);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_LOGGING_JSON_LOG_H_
