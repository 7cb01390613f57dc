#include "server/calls/status_mapping.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <string>

#include "proto/wire/error_details.h"
#include "server/errors/call_error.h"
#include "server/store/file_io.h"

namespace bccskel::server {
namespace {

// As a client reads it back.
absl::Status Back(const grpc::Status& status) {
  v1::Status details;
  EXPECT_TRUE(details.ParseFromString(status.error_details()));
  EXPECT_EQ(details.code(), static_cast<int>(status.error_code()));
  EXPECT_EQ(details.message(), status.error_message());
  return wire::FromRpcStatus(details);
}

TEST(StatusMapping, OkStaysOk) { EXPECT_TRUE(ToGrpcStatus(absl::OkStatus()).ok()); }

TEST(StatusMapping, EveryCodeKeepsItsNumberAndGetsAReason) {
  for (int code = 1; code <= 16; ++code) {
    const absl::Status status(static_cast<absl::StatusCode>(code), "why");
    const grpc::Status mapped = ToGrpcStatus(status);
    EXPECT_EQ(static_cast<int>(mapped.error_code()), code);
    EXPECT_EQ(mapped.error_message(), "why");
    const auto info = wire::ErrorInfoOf(Back(mapped));
    ASSERT_TRUE(info.has_value()) << code;
    EXPECT_FALSE(info->reason().empty());
    EXPECT_EQ(info->domain(), "bccskel");
  }
}

TEST(StatusMapping, AHandlersDetailsStayAsTheyAre) {
  const absl::Status back = Back(ToGrpcStatus(wire::InvalidField("config.threads", "is -1")));
  EXPECT_EQ(wire::ErrorInfoOf(back)->reason(), "FIELD_INVALID");
  EXPECT_EQ(wire::BadRequestOf(back)->field_violations(0).field(), "config.threads");
}

TEST(StatusMapping, AJobsWrongArgumentIsAWrongVolume) {
  const absl::Status back =
      Back(ToGrpcStatus(WithJobReason(absl::InvalidArgumentError("no magic number"))));
  EXPECT_EQ(wire::ErrorInfoOf(back)->reason(), "VOLUME_INVALID");
  EXPECT_EQ(wire::BadRequestOf(back)->field_violations(0).field(), "chunk.data");
  EXPECT_EQ(wire::BadRequestOf(back)->field_violations(0).description(), "no magic number");
}

TEST(StatusMapping, NoOtherWrongArgumentIsTakenForAVolume) {
  const absl::Status back = Back(ToGrpcStatus(absl::InvalidArgumentError("who knows")));
  EXPECT_EQ(wire::ErrorInfoOf(back)->reason(), "SERVER_DEFECT");
  EXPECT_FALSE(wire::BadRequestOf(back).has_value());
}

TEST(StatusMapping, AJobsOwnReasonStays) {
  EXPECT_EQ(ReasonNameOf(WithJobReason(wire::InvalidField("config.options", "no"))),
            "FIELD_INVALID");
  EXPECT_EQ(ReasonNameOf(WithJobReason(CallError(Reason::kDraining, "later"))), "DRAINING");
  EXPECT_EQ(ReasonNameOf(WithJobReason(absl::ResourceExhaustedError("9 of 8"))),
            "VOLUME_TOO_LARGE");
  EXPECT_EQ(ReasonNameOf(WithJobReason(absl::OkStatus())), "");
}

TEST(StatusMapping, AnErrorNamesItsField) {
  const absl::Status back =
      Back(ToGrpcStatus(InvalidField("page_token", "did not come from here")));
  EXPECT_EQ(wire::ErrorInfoOf(back)->reason(), "FIELD_INVALID");
  EXPECT_EQ(wire::BadRequestOf(back)->field_violations(0).field(), "page_token");
}

TEST(StatusMapping, AFullDiskIsNoQuotaOfTheServer) {
  const absl::Status full = WithDiskReason(absl::ResourceExhaustedError("no space in /a/b"));
  const absl::Status back = Back(ToGrpcStatus(full));
  EXPECT_EQ(wire::ErrorInfoOf(back)->reason(), "DISK_FULL");
  EXPECT_EQ(wire::QuotaFailureOf(back)->violations(0).subject(), "disk");
}

TEST(StatusMapping, AMissingFileIsNotNamed) {
  const absl::Status status = StorageError(SystemError("cannot open /srv/secret", ENOENT));
  EXPECT_EQ(status.code(), absl::StatusCode::kUnavailable);
  EXPECT_EQ(std::string(status.message()).find("/srv"), std::string::npos) << status;
  const absl::Status unknown = absl::NotFoundError("there is no job jobs/1");
  EXPECT_EQ(StorageError(unknown), unknown);
}

TEST(StatusMapping, AnErrorKeepsItsReason) {
  const absl::Status poisoned =
      CallError(Reason::kPoisoned, "ended 3 times", {.key = "attempts", .value = "3"});
  const auto info = wire::ErrorInfoOf(Back(ToGrpcStatus(poisoned)));
  EXPECT_EQ(info->reason(), "POISONED");
  EXPECT_EQ(info->metadata().at("attempts"), "3");
}

TEST(StatusMapping, WhatIsOverALimitNamesTheLimit) {
  const struct {
    Reason reason;
    const char* limit;
  } cases[] = {{Reason::kVolumeTooLarge, "max_volume_bytes"},
               {Reason::kVolumeTooLarge, "max_bricks"},
               {Reason::kDiskFull, "max_tenant_disk_bytes"}};
  for (const auto& [reason, limit] : cases) {
    const grpc::Status mapped = ToGrpcStatus(CallError(reason, "9 of 8", {.quota = limit}));
    EXPECT_EQ(mapped.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED);
    EXPECT_EQ(wire::QuotaFailureOf(Back(mapped))->violations(0).subject(), limit);
    EXPECT_FALSE(wire::RetryDelayOf(Back(mapped)).has_value()) << "trying again is of no use";
  }
}

TEST(StatusMapping, WhatIsFullNowSaysWhenToTryAgain) {
  const struct {
    Reason stated;
    const char* reason;
  } cases[] = {{Reason::kQueueFull, "QUEUE_FULL"},
               {Reason::kMemoryBusy, "MEMORY_BUSY"},
               {Reason::kDraining, "DRAINING"}};
  for (const auto& [stated, reason] : cases) {
    const grpc::Status mapped = ToGrpcStatus(CallError(stated, "later"));
    EXPECT_EQ(mapped.error_code(), grpc::StatusCode::UNAVAILABLE);
    EXPECT_EQ(wire::ErrorInfoOf(Back(mapped))->reason(), reason);
    EXPECT_GT(wire::RetryDelayOf(Back(mapped)).value_or(absl::ZeroDuration()),
              absl::ZeroDuration());
  }
}

TEST(StatusMapping, LongMessagesAreCutAndPayloadsOfOurOwnStayHere) {
  absl::Status status = absl::InternalError(std::string(100'000, 'x'));
  status.SetPayload("bccskel.server/secret", absl::Cord("inner"));
  const grpc::Status mapped = ToGrpcStatus(status);
  EXPECT_EQ(mapped.error_message().size(), wire::kMaxErrorMessageBytes);
  EXPECT_EQ(mapped.error_details().find("secret"), std::string::npos);
}

}  // namespace
}  // namespace bccskel::server
