#include "server/admission/refusal.h"

#include "absl/strings/cord.h"

namespace bccskel::server {
namespace {

constexpr char kPayloadUrl[] = "bccskel.server/refusal";

absl::StatusCode CodeOf(Refusal refusal) {
  switch (refusal) {
    case Refusal::kVolumeTooLarge:
    case Refusal::kTooManyBricks:
    case Refusal::kShellPointsTooLarge:
    case Refusal::kTooMuchMemory:
      return absl::StatusCode::kResourceExhausted;
    case Refusal::kQueueFull:
    case Refusal::kMemoryBusy:
    case Refusal::kDraining:
    case Refusal::kNoDecoder:
      return absl::StatusCode::kUnavailable;
  }
  return absl::StatusCode::kInternal;
}

}  // namespace

absl::Status Refuse(Refusal refusal, const std::string& message) {
  absl::Status status(CodeOf(refusal), message);
  status.SetPayload(kPayloadUrl, absl::Cord(std::string(1, static_cast<char>(refusal))));
  return status;
}

std::optional<Refusal> RefusalOf(const absl::Status& status) {
  const absl::optional<absl::Cord> payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return std::nullopt;
  return static_cast<Refusal>((*payload)[0]);
}

}  // namespace bccskel::server
