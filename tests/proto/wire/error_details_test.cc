#include "proto/wire/error_details.h"

#include <gtest/gtest.h>

#include <string>

namespace bccskel::wire {
namespace {

TEST(ErrorDetails, CarryReasonAndMetadata) {
  const absl::Status status =
      WithReason(absl::OutOfRangeError("offset 7"), "CHUNK_OFFSET", {{"committed_size", "5"}});
  const auto info = ErrorInfoOf(status);
  ASSERT_TRUE(info.has_value());
  EXPECT_EQ(info->reason(), "CHUNK_OFFSET");
  EXPECT_EQ(info->domain(), "bccskel");
  EXPECT_EQ(info->metadata().at("committed_size"), "5");
}

TEST(ErrorDetails, NameTheFieldAndItsProblem) {
  const absl::Status status = InvalidField("config.threads", "-1, must be at least 0");
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(std::string(status.message()), "config.threads: -1, must be at least 0");
  const auto bad_request = BadRequestOf(status);
  ASSERT_TRUE(bad_request.has_value());
  ASSERT_EQ(bad_request->field_violations_size(), 1);
  EXPECT_EQ(bad_request->field_violations(0).field(), "config.threads");
  EXPECT_TRUE(ErrorInfoOf(status).has_value());
}

TEST(ErrorDetails, CollectSeveralFields) {
  absl::Status status = WithField(absl::InvalidArgumentError("both are wrong"), "a");
  status = WithField(std::move(status), "b");
  EXPECT_EQ(BadRequestOf(status)->field_violations_size(), 2);
}

TEST(ErrorDetails, KeepFractionsOfRetryDelays) {
  const absl::Status status =
      WithRetryDelay(absl::UnavailableError("full"), absl::Milliseconds(1750));
  EXPECT_EQ(RetryDelayOf(status), absl::Milliseconds(1750));
  EXPECT_EQ(RetryDelayOf(absl::UnavailableError("full")), std::nullopt);
}

TEST(ErrorDetailsRoundTrip, ThroughTheTrailersBytes) {
  absl::Status status = WithQuota(absl::ResourceExhaustedError("too large"), "max_bricks");
  status = WithReason(std::move(status), "VOLUME_TOO_LARGE");
  v1::Status parsed;
  ASSERT_TRUE(parsed.ParseFromString(ToRpcStatus(status).SerializeAsString()));
  EXPECT_EQ(FromRpcStatus(parsed), status);
}

// Field by field what google.rpc's own definitions give.
TEST(ErrorDetails, AreGoogleRpcOnTheWire) {
  const absl::Status status = WithReason(absl::NotFoundError("m"), "R");
  const std::string url = "type.googleapis.com/google.rpc.ErrorInfo";
  const std::string info = std::string("\x0a\x01R\x12\x07") + "bccskel";
  const std::string any = std::string("\x0a\x28") + url + "\x12\x0c" + info;
  const std::string expected = std::string("\x08\x05\x12\x01m\x1a\x38") + any;
  ASSERT_EQ(url.size(), 0x28u);
  ASSERT_EQ(any.size(), 0x38u);
  EXPECT_EQ(ToRpcStatus(status).SerializeAsString(), expected);
}

TEST(ErrorDetails, CutLongMessagesBetweenCharacters) {
  std::string message(kMaxErrorMessageBytes - 1, 'a');
  message += "\xC3\xA9";  // a two-byte character across the limit
  const v1::Status cut = ToRpcStatus(absl::InternalError(message));
  EXPECT_EQ(cut.message(), std::string(kMaxErrorMessageBytes - 1, 'a'));
}

}  // namespace
}  // namespace bccskel::wire
