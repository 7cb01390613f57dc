#include "server/logging/json_log.h"

#include <spdlog/async.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

#include <atomic>
#include <cmath>

namespace bccskel::server {
namespace {

constexpr size_t kQueuedLines = 8192;

// Of the Logging that lives now.
std::atomic<spdlog::logger*> current_logger = nullptr;

spdlog::level::level_enum SpdlogLevel(LogLevel level) {
  switch (level) {
    case LogLevel::kDebug:
      return spdlog::level::debug;
    case LogLevel::kInfo:
      return spdlog::level::info;
    case LogLevel::kWarning:
      return spdlog::level::warn;
    case LogLevel::kError:
      return spdlog::level::err;
  }
  return spdlog::level::info;
}

// Length of the UTF-8 sequence at the front of `text`, 0 when it is none.
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
  if (const auto* text = std::get_if<std::string>(&field.value)) return JsonString(*text);
  if (const auto* whole = std::get_if<int64_t>(&field.value)) return fmt::format("{}", *whole);
  const double real = std::get<double>(field.value);
  return std::isfinite(real) ? fmt::format("{}", real) : "null";
}

}  // namespace

class Logging::Writer {
 public:
  explicit Writer(const std::string& level)
      : thread_(std::make_shared<spdlog::details::thread_pool>(kQueuedLines, 1)),
        logger_(std::make_shared<spdlog::async_logger>(
            "bccskel-server", std::make_shared<spdlog::sinks::stderr_sink_mt>(), thread_,
            spdlog::async_overflow_policy::overrun_oldest)) {
    logger_->set_pattern(R"({"time":"%Y-%m-%dT%H:%M:%S.%fZ","level":"%l",%v})",
                         spdlog::pattern_time_type::utc);
    logger_->set_level(spdlog::level::from_str(level));
  }

  spdlog::logger& logger() { return *logger_; }

 private:
  std::shared_ptr<spdlog::details::thread_pool> thread_;  // its end writes what is queued
  std::shared_ptr<spdlog::async_logger> logger_;
};

Logging::Logging(const std::string& level) : writer_(std::make_unique<Writer>(level)) {
  current_logger = &writer_->logger();
}

Logging::~Logging() { current_logger = nullptr; }

void Log(LogLevel level, std::string_view event, std::initializer_list<LogField> fields) {
  spdlog::logger* const logger = current_logger;
  const spdlog::level::level_enum spdlog_level = SpdlogLevel(level);
  if (logger == nullptr || !logger->should_log(spdlog_level)) return;
  std::string line = fmt::format("\"event\":{}", JsonString(event));
  for (const LogField& field : fields) {
    line += fmt::format(",{}:{}", JsonString(field.name), JsonValue(field));
  }
  logger->log(spdlog_level, "{}", line);
}

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
