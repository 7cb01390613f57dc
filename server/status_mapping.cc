#include "server/status_mapping.h"

#include <map>
#include <string>
#include <utility>

#include "proto/wire/error_details.h"
#include "server/admission/refusal.h"
#include "server/durable/fault.h"

namespace bccskel::server {
namespace {

// A job frees its place within seconds at most times; clients add jitter and back off.
const absl::Duration kRetryDelay = absl::Seconds(1);

// The reason of an error that has none of its own. Wrong arguments all have one: who finds them
// knows which they are.
const char* DefaultReason(absl::StatusCode code) {
  switch (code) {
    case absl::StatusCode::kNotFound:
      return "NOT_FOUND";
    case absl::StatusCode::kDataLoss:
      return "STORED_DATA_DAMAGED";
    case absl::StatusCode::kUnavailable:
      return "UNAVAILABLE";
    case absl::StatusCode::kCancelled:
      return "CANCELLED";
    case absl::StatusCode::kDeadlineExceeded:
      return "DEADLINE_EXCEEDED";
    default:
      return "SERVER_DEFECT";
  }
}

absl::Status WithRefusal(absl::Status status, Refusal refusal) {
  using wire::WithQuota, wire::WithReason, wire::WithRetryDelay;
  switch (refusal) {
    case Refusal::kVolumeTooLarge:
      return WithQuota(WithReason(std::move(status), "VOLUME_TOO_LARGE"), "max_volume_bytes");
    case Refusal::kTooManyBricks:
      return WithQuota(WithReason(std::move(status), "VOLUME_TOO_LARGE"), "max_bricks");
    case Refusal::kShellPointsTooLarge:
      return WithReason(std::move(status), "SHELL_POINTS_TOO_LARGE");
    case Refusal::kTooMuchMemory:
      return WithQuota(WithReason(std::move(status), "VOLUME_TOO_LARGE"), "max_admitted_bytes");
    case Refusal::kQueueFull:
      return WithRetryDelay(WithReason(std::move(status), "QUEUE_FULL"), kRetryDelay);
    case Refusal::kMemoryBusy:
      return WithRetryDelay(WithReason(std::move(status), "MEMORY_BUSY"), kRetryDelay);
    case Refusal::kDraining:
      return WithRetryDelay(WithReason(std::move(status), "DRAINING"), kRetryDelay);
    case Refusal::kNoDecoder:
      return WithRetryDelay(WithReason(std::move(status), "DECODER_BUSY"), kRetryDelay);
  }
  return status;
}

// What the ledger found, just now or before a restart.
absl::Status WithFaultDetails(absl::Status status, const Fault& fault) {
  std::map<std::string, std::string> metadata;
  if (!fault.key.empty()) metadata[fault.key] = fault.value;
  status = wire::WithReason(std::move(status), fault.reason, metadata);
  if (fault.reason == kDiskFull) status = wire::WithQuota(std::move(status), fault.value);
  return fault.field.empty() ? status : wire::WithField(std::move(status), fault.field);
}

absl::Status WithAllDetails(const absl::Status& status) {
  // Payloads of our own, such as the refusal, stay here.
  absl::Status detailed = wire::FromRpcStatus(wire::ToRpcStatus(status));
  if (const auto refusal = RefusalOf(status); refusal.has_value()) {
    return WithRefusal(absl::Status(status.code(), status.message()), *refusal);
  }
  if (wire::ErrorInfoOf(detailed).has_value()) return detailed;
  if (const auto fault = FaultOf(status); fault.has_value()) {
    return WithFaultDetails(std::move(detailed), *fault);
  }
  return wire::WithReason(std::move(detailed), DefaultReason(status.code()));
}

}  // namespace

v1::Status ToStatusMessage(const absl::Status& status) {
  return wire::ToRpcStatus(WithAllDetails(status));
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const v1::Status detailed = ToStatusMessage(status);
  return grpc::Status(static_cast<grpc::StatusCode>(detailed.code()), detailed.message(),
                      detailed.SerializeAsString());
}

std::string ReasonOf(const absl::Status& status) {
  if (status.ok()) return std::string();
  return wire::ErrorInfoOf(WithAllDetails(status))->reason();
}

absl::Status WithJobReason(const absl::Status& status) {
  if (wire::ErrorInfoOf(status).has_value() || RefusalOf(status).has_value() ||
      FaultOf(status).has_value()) {
    return status;
  }
  if (absl::IsResourceExhausted(status)) {  // the number of bricks
    return wire::WithQuota(wire::WithReason(status, "VOLUME_TOO_LARGE"), "max_bricks");
  }
  return absl::IsInvalidArgument(status) ? WrongVolume(std::string(status.message())) : status;
}

}  // namespace bccskel::server
