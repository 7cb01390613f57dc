#include "server/logging/json_log.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <thread>
#include <vector>

namespace bccskel::server {
namespace {

// What `log` leaves on standard error at this level.
template <typename Action>
std::string Logged(const std::string& level, Action log) {
  testing::internal::CaptureStderr();
  {
    const Logging logging(level);
    log();
  }
  return testing::internal::GetCapturedStderr();
}

TEST(JsonLog, WritesAnObjectALine) {
  const std::string line = Logged("info", [] {
    Log(LogLevel::kInfo, "done", {{"jobs", int64_t{3}}, {"seconds", 0.5}, {"name", "a\"b"}});
  });
  EXPECT_THAT(line, testing::MatchesRegex(R"(\{"time":"[0-9T:.-]+Z","level":"info","event":"done",)"
                                          R"("jobs":3,"seconds":0.5,"name":"a\\"b"\}.)"));
  EXPECT_EQ(std::count(line.begin(), line.end(), '\n'), 1);
}

TEST(JsonLog, LeavesOutWhatIsBelowItsLevel) {
  const auto one_of_each = [] {
    for (const LogLevel level :
         {LogLevel::kDebug, LogLevel::kInfo, LogLevel::kWarning, LogLevel::kError}) {
      Log(level, "event");
    }
  };
  const auto lines_at = [&](const char* level) {
    const std::string text = Logged(level, one_of_each);
    return std::count(text.begin(), text.end(), '\n');
  };
  EXPECT_EQ(lines_at("trace"), 4);
  EXPECT_EQ(lines_at("debug"), 4);
  EXPECT_EQ(lines_at("info"), 3);
  EXPECT_EQ(lines_at("warning"), 2);
  EXPECT_EQ(lines_at("error"), 1);
  EXPECT_EQ(lines_at("off"), 0);
}

TEST(JsonLog, LinesOfManyThreadsAreAllThereAndWhole) {
  constexpr int kThreads = 4, kLines = 500;
  const std::string text = Logged("info", [] {
    std::vector<std::jthread> threads;
    for (int n = 0; n < kThreads; ++n) {
      threads.emplace_back([] {
        for (int line = 0; line < kLines; ++line) Log(LogLevel::kInfo, "tick");
      });
    }
  });
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), kThreads * kLines);
  size_t whole = 0;
  for (size_t at = text.find("\"tick\"}\n"); at != std::string::npos;
       at = text.find("\"tick\"}\n", at + 1)) {
    ++whole;
  }
  EXPECT_EQ(whole, size_t{kThreads} * kLines);
}

TEST(JsonLog, WithoutALoggingNothingIsWritten) {
  testing::internal::CaptureStderr();
  Log(LogLevel::kError, "unheard");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(JsonLog, ValuesThatJsonDoesNotKnowBecomeNull) {
  const std::string line = Logged("info", [] {
    Log(LogLevel::kInfo, "e",
        {{"a", std::nan("")}, {"b", std::numeric_limits<double>::infinity()}});
  });
  EXPECT_THAT(line, testing::HasSubstr(R"("a":null,"b":null)"));
}

TEST(JsonLog, StringsAreEscapedAndAlwaysUtf8) {
  EXPECT_EQ(JsonString(""), R"("")");
  EXPECT_EQ(JsonString("a\\b\"c"), R"("a\\b\"c")");
  EXPECT_EQ(JsonString("line\nbreak\x01\x7f"), R"("line\u000abreak\u0001\u007f")");
  EXPECT_EQ(JsonString("\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8D\x8E"),
            "\"\xC3\xA9\xE2\x82\xAC\xF0\x9F\x8D\x8E\"");
  EXPECT_EQ(JsonString("a\xFFz"), R"("a\ufffdz")");
  EXPECT_EQ(JsonString("\xE2\x82"), R"("\ufffd\ufffd")") << "cut in the middle";
  EXPECT_EQ(JsonString("\xC0\xAF"), R"("\ufffd\ufffd")") << "an overlong slash";
}

}  // namespace
}  // namespace bccskel::server
