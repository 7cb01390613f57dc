#include "client/cli/console.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/cli/load_object.h"
#include "client/cli/progress_bar.h"
#include "client/cli/summaries.h"

namespace bccskel::cli {
namespace {

using testing::HasSubstr;

TEST(ExitCodeTest, FollowsFromTheKindOfError) {
  EXPECT_EQ(ExitCodeOf(absl::OkStatus()), ExitCode::kOk);
  EXPECT_EQ(ExitCodeOf(absl::InvalidArgumentError("")), ExitCode::kBadInput);
  EXPECT_EQ(ExitCodeOf(absl::NotFoundError("")), ExitCode::kBadInput);
  EXPECT_EQ(ExitCodeOf(absl::FailedPreconditionError("")), ExitCode::kBadInput);
  EXPECT_EQ(ExitCodeOf(absl::UnimplementedError("")), ExitCode::kBadInput);
  EXPECT_EQ(ExitCodeOf(absl::UnavailableError("")), ExitCode::kUnavailable);
  EXPECT_EQ(ExitCodeOf(absl::DeadlineExceededError("")), ExitCode::kStopped);
  EXPECT_EQ(ExitCodeOf(absl::CancelledError("")), ExitCode::kStopped);
  EXPECT_EQ(ExitCodeOf(absl::ResourceExhaustedError("")), ExitCode::kTooLarge);
  EXPECT_EQ(ExitCodeOf(absl::DataLossError("")), ExitCode::kInternal);
  EXPECT_EQ(ExitCodeOf(absl::InternalError("")), ExitCode::kInternal);
  EXPECT_EQ(ExitCodeOf(absl::UnauthenticatedError("")), ExitCode::kCredentials);
}

TEST(ConsoleTest, ErrorsAndHintsGoToStandardError) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  EXPECT_EQ(Fail(absl::UnavailableError("nobody there"), "start it"), ExitCode::kUnavailable);
  EXPECT_EQ(testing::internal::GetCapturedStderr(),
            "bccskel: error: nobody there\nbccskel: hint: start it\n");
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

ServerArguments ServerAt(const std::string& address) {
  ServerArguments server;
  server.address = address;
  return server;
}

TEST(ConsoleTest, AJobIsCancelledOnAServerAlone) {
  const absl::Status stopped = absl::CancelledError("a.off: the job was cancelled");
  testing::internal::CaptureStderr();
  EXPECT_EQ(Fail(stopped), ExitCode::kStopped);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "bccskel: error: a.off: interrupted\n");
  testing::internal::CaptureStderr();
  EXPECT_EQ(FailOnServer(ServerAt("a:1"), stopped), ExitCode::kStopped);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("the job was cancelled"));
}

TEST(ConsoleTest, ATokenThatIsNotForACallIsAQuestionOfCredentials) {
  testing::internal::CaptureStderr();
  EXPECT_EQ(FailOnServer(ServerAt("a:1"), absl::PermissionDeniedError("no")),
            ExitCode::kCredentials);
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "bccskel: error: server a:1: no\n");
}

TEST(ConsoleTest, APlainConnectionThatBreaksOffMayWantTls) {
  const std::string failed = "failed to connect to all addresses; last error: ";
  const auto broke =
      absl::UnavailableError(failed + "UNAVAILABLE: ipv4:127.0.0.1:1: Socket closed");
  testing::internal::CaptureStderr();
  FailOnServer(ServerAt("a:1"), broke);
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("--tls-ca"));
  testing::internal::CaptureStderr();
  FailOnServer(ServerAt("unix:/a"), broke);
  ServerArguments with_tls = ServerAt("a:1");
  with_tls.tls_ca = "ca";
  FailOnServer(with_tls, broke);
  FailOnServer(ServerAt("a:1"),
               absl::UnavailableError(failed + "UNKNOWN: ipv4:127.0.0.1:1: Failed to connect to "
                                               "remote host: Connection refused"));
  FailOnServer(ServerAt("a:1"),
               absl::UnavailableError("DNS resolution failed for a:1: Domain name not found"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), testing::Not(HasSubstr("tls")));
}

TEST(ConsoleTest, AServerThatWantsATokenLeadsToTheOption) {
  testing::internal::CaptureStderr();
  FailOnServer(ServerAt("a:1"), absl::UnauthenticatedError("wants one"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("hint: name the file of your token "
                                                                "with --token-file"));
  testing::internal::CaptureStderr();
  ServerArguments with_token = ServerAt("a:1");
  with_token.token_file = "wrong";
  FailOnServer(with_token, absl::UnauthenticatedError("not accepted"));
  EXPECT_THAT(testing::internal::GetCapturedStderr(), HasSubstr("hint: check the token's file"));
}

TEST(JsonStringTest, EscapesQuotesAndControlCharactersAndKeepsUtf8) {
  EXPECT_EQ(JsonString("a\"b\\c\n\x01"), "\"a\\\"b\\\\c\\u000a\\u0001\"");
  EXPECT_EQ(JsonString("né\xF0\x9F\xA6\xB4"), "\"né\xF0\x9F\xA6\xB4\"");
}

TEST(JsonStringTest, BytesThatAreNotUtf8BecomeTheReplacementCharacter) {
  EXPECT_EQ(JsonString("\xff"), "\"\\ufffd\"");
  EXPECT_EQ(JsonString("\xc3"), "\"\\ufffd\"");                        // cut
  EXPECT_EQ(JsonString("\xc0\xaf"), "\"\\ufffd\\ufffd\"");             // too long a form
  EXPECT_EQ(JsonString("\xed\xa0\x80"), "\"\\ufffd\\ufffd\\ufffd\"");  // half of a pair
}

TEST(InputKindTest, FollowsFromTheNameInCapitalsOrNot) {
  EXPECT_EQ(*InputKindOf("a.OBJ"), InputKind::kMesh);
  EXPECT_EQ(*InputKindOf("a.stl.gz"), InputKind::kMesh);
  EXPECT_EQ(*InputKindOf("a.exr"), InputKind::kVolume);
  EXPECT_EQ(*InputKindOf("a.bccb"), InputKind::kVolume);
  EXPECT_EQ(*InputKindOf("a.nii.gz"), InputKind::kImage);
  EXPECT_TRUE(absl::IsInvalidArgument(InputKindOf("/dev/null").status()));
  EXPECT_TRUE(absl::IsNotFound(InputKindOf("a.docx").status()));
}

TEST(ProgressLineTest, ShowsHowFarTheShellsAre) {
  const exec::ShellProgress progress = {
      .shell = 7, .last_shell = 14, .points = 3, .removed = 1234567, .remaining = 89};
  EXPECT_EQ(ProgressLine(progress, std::chrono::milliseconds(1250)),
            "[##############--------------] shell 7/14  1,234,567 points removed, 89 left  1.2 s");
}

TEST(ProgressLineTest, StandsWithoutShells) {
  EXPECT_THAT(ProgressLine({}, std::chrono::seconds(0)),
              HasSubstr("[----------------------------] shell 0/0"));
}

TEST(ProgressBarTest, IsSilentInAPipeUnlessAskedFor) {
  testing::internal::CaptureStderr();  // a file, not a terminal
  EXPECT_FALSE(ProgressBar(ProgressStyle::kAuto).Callback("a"));
  EXPECT_FALSE(ProgressBar(ProgressStyle::kNever).Callback("a"));
  ProgressBar lines(ProgressStyle::kAlways);
  lines.Callback("a")({.shell = 1, .last_shell = 2});
  lines.Callback("a")({.shell = 2, .last_shell = 2});
  const std::string printed = testing::internal::GetCapturedStderr();
  EXPECT_THAT(printed, HasSubstr("shell 1/2"));
  EXPECT_THAT(printed, HasSubstr("shell 2/2"));
  EXPECT_EQ(printed.find('\r'), printed.npos);
}

}  // namespace
}  // namespace bccskel::cli
