#include "server/errors/call_error.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

#include "absl/strings/cord.h"

namespace bccskel::server {
namespace {

TEST(CallErrorTest, EachReasonHasANameOfItsOwnAndIsFoundByIt) {
  std::set<std::string> names;
  for (int n = 0; n <= static_cast<int>(Reason::kServerDefect); ++n) {
    const auto reason = static_cast<Reason>(n);
    EXPECT_TRUE(names.insert(NameOf(reason)).second) << NameOf(reason);
    const absl::Status status = CallError(reason, "why");
    EXPECT_FALSE(status.ok());
    EXPECT_EQ(ReasonOf(status), reason);
    EXPECT_EQ(IsWorthARetry(reason) && !absl::IsUnavailable(status), false) << NameOf(reason);
  }
}

TEST(CallErrorTest, KeepsItsDetails) {
  const absl::Status status = CallError(
      Reason::kDiskFull, "full", {.field = "a.b", .quota = "limit", .key = "k", .value = "v"});
  EXPECT_EQ(status.code(), absl::StatusCode::kResourceExhausted);
  const ErrorDetails details = DetailsOf(Prefixed("what", status));
  EXPECT_EQ(details.field, "a.b");
  EXPECT_EQ(details.quota, "limit");
  EXPECT_EQ(details.key, "k");
  EXPECT_EQ(details.value, "v");
  EXPECT_EQ(Prefixed("what", status).message(), "what: full");
}

TEST(CallErrorTest, IsNotFoundInOtherErrors) {
  EXPECT_EQ(ReasonOf(absl::UnavailableError("queue full")), std::nullopt);
  EXPECT_EQ(ReasonOf(absl::OkStatus()), std::nullopt);
  EXPECT_EQ(DetailsOf(absl::OutOfRangeError("no")).key, "");
  EXPECT_EQ(NeededBytesOf(WrongOffset("no", 7)), std::nullopt);
}

TEST(CallErrorTest, TellsACallerWhereToResume) {
  const ErrorDetails details = DetailsOf(WrongOffset("no", 7));
  EXPECT_EQ(details.key, "committed_size");
  EXPECT_EQ(details.value, "7");
}

TEST(CallErrorTest, IsNotFoundInADamagedPayload) {
  for (const char* damaged : {"", "x", "NO_SUCH_REASON\n\n\n\n", "DISK_FULL\nlimit\ndisk"}) {
    absl::Status status(absl::StatusCode::kInternal, "stored");
    status.SetPayload("bccskel.server/fault", absl::Cord(damaged));
    EXPECT_EQ(ReasonOf(status), std::nullopt) << damaged;
  }
}

TEST(CallErrorTest, AJobsErrorWithoutAReasonIsTheVolumes) {
  EXPECT_EQ(ReasonOf(WithJobReason(absl::InvalidArgumentError("no magic"))),
            Reason::kVolumeInvalid);
  const absl::Status large = WithJobReason(absl::ResourceExhaustedError("9 of 8"));
  EXPECT_EQ(ReasonOf(large), Reason::kVolumeTooLarge);
  EXPECT_EQ(DetailsOf(large).quota, "max_bricks");
  EXPECT_EQ(ReasonOf(WithJobReason(InvalidField("a", "b"))), Reason::kFieldInvalid);
  EXPECT_EQ(DefaultReason(absl::StatusCode::kNotFound), Reason::kNotFound);
  EXPECT_EQ(DefaultReason(absl::StatusCode::kUnavailable), Reason::kUnavailable);
  EXPECT_EQ(DefaultReason(absl::StatusCode::kInvalidArgument), Reason::kServerDefect);
}

}  // namespace
}  // namespace bccskel::server
