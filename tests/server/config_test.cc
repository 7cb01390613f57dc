#include "server/config.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <variant>
#include <vector>

namespace bccskel::server {
namespace {

std::variant<ServerConfig, ExitRequest> Parse(std::vector<const char*> arguments) {
  arguments.insert(arguments.begin(), "bccskel-server");
  return ParseServerConfig(static_cast<int>(arguments.size()), arguments.data());
}

ServerConfig Parsed(const std::vector<const char*>& arguments) {
  const auto parsed = Parse(arguments);
  if (const auto* exit = std::get_if<ExitRequest>(&parsed)) {
    ADD_FAILURE() << exit->err;
    return ServerConfig();
  }
  return std::get<ServerConfig>(parsed);
}

TEST(ServerConfig, ListensOnLoopbackByDefaultWithinThisMachine) {
  const ServerConfig config = Parsed({});
  EXPECT_THAT(config.listen, testing::ElementsAre("127.0.0.1:50051"));
  EXPECT_GE(config.limits.threads, 1);
  EXPECT_GE(config.limits.max_jobs, 1);
  EXPECT_GT(config.limits.max_bytes, uint64_t{1} << 20);
  EXPECT_EQ(config.log_level, "info");
  EXPECT_LT(config.lame_duck + config.drain, std::chrono::seconds(30));
}

TEST(ServerConfig, TakesEveryFlag) {
  const ServerConfig config = Parsed(
      {"--listen",     "unix:/run/x", "--threads",           "3",   "--max-jobs",         "2",
       "--max-queue",  "0",           "--max-memory-bytes",  "2GB", "--max-volume-bytes", "3MB",
       "--max-bricks", "77",          "--lame-duck-ms",      "5",   "--drain-ms",         "6",
       "--log-level",  "warning",     "--sender-timeout-ms", "7"});
  EXPECT_THAT(config.listen, testing::ElementsAre("unix:/run/x"));
  EXPECT_EQ(config.limits.threads, 3);
  EXPECT_EQ(config.limits.max_jobs, 2);
  EXPECT_EQ(config.limits.max_queue, 0);
  EXPECT_EQ(config.limits.max_bytes, uint64_t{2} << 30);
  EXPECT_EQ(config.limits.max_volume_bytes, uint64_t{3} << 20);
  EXPECT_EQ(config.limits.volume.max_bricks, 77u);
  EXPECT_EQ(config.caller_timeouts.sender, std::chrono::milliseconds(7));
  EXPECT_EQ(config.lame_duck, std::chrono::milliseconds(5));
  EXPECT_EQ(config.drain, std::chrono::milliseconds(6));
  EXPECT_EQ(config.log_level, "warning");
}

TEST(ServerConfig, RunsAsManyJobsAsThreadsUnlessToldOtherwise) {
  EXPECT_EQ(Parsed({"--threads", "3"}).limits.max_jobs, 3);
  EXPECT_EQ(Parsed({"--max-jobs", "5"}).limits.max_jobs, 5);
}

class BadFlagTest : public testing::TestWithParam<std::vector<const char*>> {};

TEST_P(BadFlagTest, EndsWithCodeTwoAndNamesTheFlag) {
  const auto parsed = Parse(GetParam());
  ASSERT_TRUE(std::holds_alternative<ExitRequest>(parsed));
  const auto& exit = std::get<ExitRequest>(parsed);
  EXPECT_EQ(exit.code, 2);
  EXPECT_THAT(exit.err, testing::HasSubstr(GetParam()[0]));
  EXPECT_THAT(exit.err, testing::StartsWith("bccskel-server: "));
}

INSTANTIATE_TEST_SUITE_P(
    ServerConfig, BadFlagTest,
    testing::Values(
        std::vector<const char*>{"--no-such-flag"}, std::vector<const char*>{"--threads", "0"},
        std::vector<const char*>{"--threads", "many"}, std::vector<const char*>{"--max-jobs", "-1"},
        std::vector<const char*>{"--max-queue", "-1"},
        std::vector<const char*>{"--max-memory-bytes", "2 furlongs"},
        std::vector<const char*>{"--max-bricks", "0"}, std::vector<const char*>{"--drain-ms", "-1"},
        std::vector<const char*>{"--lame-duck-ms", "soon"},
        std::vector<const char*>{"--log-level", "loud"}, std::vector<const char*>{"--listen"},
        std::vector<const char*>{"--listen", "nonsense"},
        std::vector<const char*>{"--listen", "unix:"},
        std::vector<const char*>{"--listen", "127.0.0.1:99999"},
        std::vector<const char*>{"--listen", "127.0.0.1:http"},
        std::vector<const char*>{"--listen", ":80"}, std::vector<const char*>{"--new-token"},
        std::vector<const char*>{"--job-store", "postgresql://a:secret@b/c", "--data-dir", "d"},
        std::vector<const char*>{"surplus"}));

TEST(ServerConfig, AValueThatIsMissingAndAFlagThatIsNoneAreExplained) {
  const auto error_of = [](const std::vector<const char*>& flags) {
    return std::get<ExitRequest>(Parse(flags)).err;
  };
  const std::string hint = "\nbccskel-server: see --help\n";
  EXPECT_EQ(error_of({"--new-token"}),
            "bccskel-server: --new-token: needs a value: --new-token TENANT" + hint);
  EXPECT_EQ(error_of({"--threads"}),
            "bccskel-server: --threads: needs a value: --threads N" + hint);
  EXPECT_EQ(error_of({"--bogus", "3"}), "bccskel-server: there is no setting --bogus" + hint);
}

TEST(ServerConfig, VersionAndHelpGoToStandardOutputAndAreNoError) {
  for (const char* flag : {"--version", "--help"}) {
    const auto parsed = Parse({flag});
    ASSERT_TRUE(std::holds_alternative<ExitRequest>(parsed));
    EXPECT_EQ(std::get<ExitRequest>(parsed).code, 0);
    EXPECT_THAT(std::get<ExitRequest>(parsed).out, testing::HasSubstr("bccskel-server"));
    EXPECT_EQ(std::get<ExitRequest>(parsed).err, "");
  }
}

}  // namespace
}  // namespace bccskel::server
