#include "server/errors/call_error.h"

#include <cstdlib>
#include <string_view>
#include <vector>

#include "absl/strings/cord.h"
#include "absl/strings/str_cat.h"
#include "absl/strings/str_split.h"

namespace bccskel::server {
namespace {

using absl::StatusCode;

enum class Retry { kNo, kYes };

struct Meaning {
  Reason reason;
  const char* name;
  StatusCode code;
  Retry retry;
};

constexpr Meaning kMeanings[] = {
#define BCCSKEL_REASON(reason, name, code, retry) \
  {Reason::reason, name, StatusCode::code, Retry::retry},
    BCCSKEL_REASONS(BCCSKEL_REASON)
#undef BCCSKEL_REASON
};

const Meaning& MeaningOf(Reason reason) { return kMeanings[static_cast<size_t>(reason)]; }

// Occurs in stored jobs: lines of reason, key, value, field and quota.
constexpr char kPayloadUrl[] = "bccskel.server/fault";
constexpr char kWireUrl[] = "type.googleapis.com/google.rpc.ErrorInfo";
constexpr char kNeededBytes[] = "needed_bytes";

struct Stated {
  Reason reason = Reason::kServerDefect;
  ErrorDetails details;
};

std::optional<Stated> StatedBy(const absl::Status& status) {
  const auto payload = status.GetPayload(kPayloadUrl);
  if (!payload.has_value()) return std::nullopt;
  const std::vector<std::string> parts = absl::StrSplit(std::string(*payload), '\n');
  if (parts.size() < 5) return std::nullopt;
  for (const Meaning& meaning : kMeanings) {
    if (parts[0] != meaning.name) continue;
    return Stated{meaning.reason,
                  {.field = parts[3], .quota = parts[4], .key = parts[1], .value = parts[2]}};
  }
  return std::nullopt;
}

std::string TextOf(const absl::Status& status) { return std::string(status.message()); }

}  // namespace

absl::Status CallError(Reason reason, const std::string& message, const ErrorDetails& details) {
  const Meaning& meaning = MeaningOf(reason);
  absl::Status status(meaning.code, message);
  status.SetPayload(kPayloadUrl,
                    absl::Cord(absl::StrCat(meaning.name, "\n", details.key, "\n", details.value,
                                            "\n", details.field, "\n", details.quota)));
  return status;
}

absl::Status InvalidField(const std::string& field, const std::string& description) {
  return CallError(Reason::kFieldInvalid, absl::StrCat(field, ": ", description), {.field = field});
}

absl::Status InvalidVolume(const std::string& message) {
  return CallError(Reason::kVolumeInvalid, message, {.field = "chunk.data"});
}

absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes) {
  return CallError(Reason::kChunkOffset, message,
                   {.key = "committed_size", .value = absl::StrCat(committed_bytes)});
}

absl::Status MemoryBusy(const std::string& message, uint64_t needed_bytes) {
  return CallError(Reason::kMemoryBusy, message,
                   {.key = kNeededBytes, .value = absl::StrCat(needed_bytes)});
}

absl::Status DiskFull(const std::string& message, const std::string& quota) {
  return CallError(Reason::kDiskFull, message, {.quota = quota, .key = "limit", .value = quota});
}

absl::Status JobCancelled() { return CallError(Reason::kCancelled, "the job was cancelled"); }

bool StatesReason(const absl::Status& status) {
  return ReasonOf(status).has_value() || status.GetPayload(kWireUrl).has_value();
}

std::optional<Reason> ReasonOf(const absl::Status& status) {
  const std::optional<Stated> stated = StatedBy(status);
  return stated.has_value() ? std::optional(stated->reason) : std::nullopt;
}

ErrorDetails DetailsOf(const absl::Status& status) {
  return StatedBy(status).value_or(Stated()).details;
}

std::optional<uint64_t> NeededBytesOf(const absl::Status& status) {
  const ErrorDetails details = DetailsOf(status);
  if (details.key != kNeededBytes) return std::nullopt;
  return std::strtoull(details.value.c_str(), nullptr, 10);
}

const char* NameOf(Reason reason) { return MeaningOf(reason).name; }
bool IsWorthARetry(Reason reason) { return MeaningOf(reason).retry == Retry::kYes; }

Reason DefaultReason(StatusCode code) {
  for (const Reason reason : {Reason::kNotFound, Reason::kStoredDataDamaged, Reason::kUnavailable,
                              Reason::kCancelled, Reason::kDeadlineExceeded}) {
    if (MeaningOf(reason).code == code) return reason;
  }
  return Reason::kServerDefect;
}

absl::Status WithJobReason(const absl::Status& status) {
  if (StatesReason(status)) return status;
  if (absl::IsResourceExhausted(status)) {  // the number of bricks
    return CallError(Reason::kVolumeTooLarge, TextOf(status), {.quota = "max_bricks"});
  }
  return absl::IsInvalidArgument(status) ? InvalidVolume(TextOf(status)) : status;
}

absl::Status WithDiskReason(const absl::Status& status) {
  if (!absl::IsResourceExhausted(status) || ReasonOf(status).has_value()) return status;
  return DiskFull(
      "the server's disk is full: delete jobs and volumes that are no longer needed, or give the "
      "server's data folder more space",
      "disk");
}

absl::Status Prefixed(const std::string& what, const absl::Status& status) {
  absl::Status prefixed(status.code(), absl::StrCat(what, ": ", TextOf(status)));
  status.ForEachPayload([&prefixed](absl::string_view url, const absl::Cord& payload) {
    prefixed.SetPayload(url, payload);
  });
  return prefixed;
}

}  // namespace bccskel::server
