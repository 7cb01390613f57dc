#include "server/logging/json_log.h"

#include <google/protobuf/stubs/logging.h>
#include <grpc/support/log.h>
#include <poll.h>
#include <spdlog/async.h>
#include <spdlog/sinks/base_sink.h>
#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <cmath>

namespace bccskel::server {
namespace {

constexpr size_t kQueuedLines = 8192;
constexpr size_t kMostTextBytes = 4096;  // of one field; longer ones are truncated

// Lines dropped since the process began.
std::atomic<uint64_t> dropped_lines = 0;

// Logger of the current Logging.
std::atomic<spdlog::logger*> current_logger = nullptr;

// Length of the UTF-8 sequence at the front of `text`; 0 if it is invalid.
size_t SequenceLength(std::string_view text) {
  const auto byte = [text](size_t n) { return static_cast<unsigned char>(text[n]); };
  const size_t length = byte(0) < 0x80                       ? 1
                        : byte(0) >= 0xC2 && byte(0) <= 0xDF ? 2
                        : byte(0) >= 0xE0 && byte(0) <= 0xEF ? 3
                        : byte(0) >= 0xF0 && byte(0) <= 0xF4 ? 4
                                                             : 0;
  if (length == 0 || length > text.size()) return 0;
  for (size_t n = 1; n < length; ++n) {
    if ((byte(n) & 0xC0) != 0x80) return 0;
  }
  return length;
}

std::string JsonValue(const LogField& field) {
  if (const auto* text = std::get_if<std::string>(&field.value)) {
    return JsonString(std::string_view(*text).substr(0, kMostTextBytes));
  }
  if (const auto* whole = std::get_if<int64_t>(&field.value)) return fmt::format("{}", *whole);
  const double real = std::get<double>(field.value);
  return std::isfinite(real) ? fmt::format("{}", real) : "null";
}

// Writes to standard error from one thread. A pipe that nobody reads blocks that thread until it
// must stop; a second after that, the remaining lines are dropped.
class StandardError final : public spdlog::sinks::base_sink<spdlog::details::null_mutex> {
 public:
  void StopSoon() { end_ = Clock::now() + std::chrono::seconds(1); }
  // Sets the queue of the writing thread, which counts dropped lines.
  void Watch(spdlog::details::thread_pool& queue) { queue_ = &queue; }

 private:
  using Clock = std::chrono::steady_clock;

  void sink_it_(const spdlog::details::log_msg& message) override {
    spdlog::memory_buf_t line;
    Count();
    if (dropped_lines > told_) {
      const std::string text = fmt::format("\"event\":\"log lines dropped\",\"lines\":{}",
                                           dropped_lines - std::exchange(told_, dropped_lines));
      formatter_->format({message.time, {}, {}, spdlog::level::warn, text}, line);
    }
    formatter_->format(message, line);
    Write({line.data(), line.size()});
  }
  void flush_() override {}

  void Count() { dropped_lines = lost_ + queue_->overrun_counter(); }

  void Write(std::string_view text) {
    constexpr int kLookMs = 50;
    while (!text.empty()) {
      pollfd ready = {.fd = STDERR_FILENO, .events = POLLOUT, .revents = 0};
      const bool over = Clock::now() >= end_.load();
      const int found = poll(&ready, 1, over ? 0 : kLookMs);
      if (found <= 0 && !over) {
        Count();
        continue;
      }
      // A pipe that polls as writable takes this much without blocking.
      const ssize_t put =
          found <= 0 ? -1
                     : write(STDERR_FILENO, text.data(), std::min<size_t>(text.size(), PIPE_BUF));
      if (put < 0 && found > 0 && (errno == EINTR || errno == EAGAIN)) continue;
      if (put < 0) {
        ++lost_;
        return Count();
      }
      text.remove_prefix(static_cast<size_t>(put));
    }
  }

  spdlog::details::thread_pool* queue_ = nullptr;  // outlives the writing thread
  uint64_t lost_ = 0;                              // lines that could not be written
  uint64_t told_ = 0;                              // of the dropped lines, those reported
  std::atomic<Clock::time_point> end_ = Clock::time_point::max();
};

// Most of the libraries' errors are caused by callers; none of them ends the server.
LogLevel LevelOf(bool error) { return error ? LogLevel::kWarning : LogLevel::kDebug; }

void WriteGrpc(gpr_log_func_args* said) {
  Log(LevelOf(said->severity == GPR_LOG_SEVERITY_ERROR), "grpc",
      {{"message", std::string(said->message)}});
}

void WriteProtobuf(google::protobuf::LogLevel level, const char*, int, const std::string& message) {
  Log(LevelOf(level >= google::protobuf::LOGLEVEL_ERROR), "protobuf", {{"message", message}});
}

}  // namespace

class Logging::Writer {
 public:
  explicit Writer(const std::string& level)
      : thread_(std::make_shared<spdlog::details::thread_pool>(kQueuedLines, 1)),
        logger_(std::make_shared<spdlog::async_logger>(
            "bccskel-server", stderr_, thread_, spdlog::async_overflow_policy::overrun_oldest)) {
    stderr_->Watch(*thread_);
    logger_->set_pattern(R"({"time":"%Y-%m-%dT%H:%M:%S.%fZ","level":"%l",%v})",
                         spdlog::pattern_time_type::utc);
    logger_->set_level(spdlog::level::from_str(level));
    logger_->set_error_handler([](const std::string&) {});
  }
  ~Writer() { stderr_->StopSoon(); }

  spdlog::logger& logger() { return *logger_; }

 private:
  const std::shared_ptr<StandardError> stderr_ = std::make_shared<StandardError>();
  std::shared_ptr<spdlog::details::thread_pool> thread_;  // its destructor writes what is queued
  std::shared_ptr<spdlog::async_logger> logger_;
};

Logging::Logging(const std::string& level) : writer_(std::make_unique<Writer>(level)) {
  current_logger = &writer_->logger();
}

Logging::~Logging() { current_logger = nullptr; }

void Log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  spdlog::logger* const logger = current_logger;
  const spdlog::level::level_enum spdlog_level = static_cast<spdlog::level::level_enum>(level);
  if (logger == nullptr || !logger->should_log(spdlog_level)) return;
  std::string line = fmt::format("\"event\":{}", JsonString(event));
  for (const LogField& field : fields) {
    line += fmt::format(",{}:{}", JsonString(field.name), JsonValue(field));
  }
  logger->log(spdlog_level, "{}", line);
}

void LogLibraryMessages() {
  gpr_set_log_function(WriteGrpc);
  google::protobuf::SetLogHandler(WriteProtobuf);
}

uint64_t DroppedLogLines() { return dropped_lines; }

std::string JsonString(std::string_view text) {
  std::string json = "\"";
  while (!text.empty()) {
    const size_t length = SequenceLength(text);
    const auto first = static_cast<unsigned char>(text[0]);
    if (length == 0) {
      json += "\\ufffd";
    } else if (first < 0x20 || first == 0x7F) {
      json += fmt::format("\\u{:04x}", first);
    } else {
      if (first == '"' || first == '\\') json += '\\';
      json += text.substr(0, length);
    }
    text.remove_prefix(length == 0 ? 1 : length);
  }
  json += '"';
  return json;
}

}  // namespace bccskel::server
