#include "server/durable/fault.h"

#include <cstdlib>
#include <vector>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"
#include "server/durable/ledger.h"
#include "server/store/disk_quota.h"

namespace bccskel::server {
namespace {

constexpr char kPayloadUrl[] = "bccskel.server/fault";
constexpr char kCommittedSize[] = "committed_size";

}  // namespace

absl::Status WithFault(absl::Status status, const Fault& fault) {
  status.SetPayload(kPayloadUrl, absl::Cord(absl::StrCat(fault.reason, "\n", fault.key, "\n",
                                                         fault.value, "\n", fault.field)));
  return status;
}

std::optional<Fault> FaultOf(const absl::Status& status) {
  const auto payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return std::nullopt;
  const std::vector<std::string> parts = absl::StrSplit(std::string(*payload), '\n');
  if (parts.size() < 3) return std::nullopt;
  // Errors that older servers have stored have no field.
  const std::string field = parts.size() > 3 ? parts[3] : std::string();
  return Fault{.reason = parts[0], .key = parts[1], .value = parts[2], .field = field};
}

absl::Status WithDiskFault(const absl::Status& status) {
  if (!absl::IsResourceExhausted(status) || FaultOf(status).has_value()) return status;
  const std::string quota = ExceededQuota(status);
  const bool full = quota.empty();  // then the message names files and statements
  return WithFault(full ? absl::ResourceExhaustedError("the server's disk is full") : status,
                   {.reason = kDiskFull, .key = "limit", .value = full ? "max_disk_bytes" : quota});
}

absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes) {
  return WithFault(
      absl::OutOfRangeError(message),
      {.reason = "CHUNK_OFFSET", .key = kCommittedSize, .value = absl::StrCat(committed_bytes)});
}

absl::Status WrongField(const std::string& field, const std::string& description) {
  return WithFault(absl::InvalidArgumentError(absl::StrCat(field, ": ", description)),
                   {.reason = "FIELD_INVALID", .field = field});
}

absl::Status WrongVolume(const std::string& message) {
  return WithFault(absl::InvalidArgumentError(message),
                   {.reason = "VOLUME_INVALID", .field = "chunk.data"});
}

std::optional<uint64_t> CommittedSizeOf(const absl::Status& status) {
  const std::optional<Fault> fault = FaultOf(status);
  if (!fault.has_value() || fault->key != kCommittedSize) return std::nullopt;
  return std::strtoull(fault->value.c_str(), nullptr, 10);
}

}  // namespace bccskel::server
