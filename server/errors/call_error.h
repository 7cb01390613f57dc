#ifndef BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_
#define BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Why a call or a job fails, as callers see it. ERRORS.md describes them; the .cc has their names
// and codes, and which are worth another try.
enum class Reason : uint8_t {
  kFieldInvalid,
  kVolumeInvalid,
  kVolumeSize,
  kVolumeTruncated,
  kRequestOrder,
  kRequestMalformed,
  kChunkChecksum,
  kChunkOffset,
  kPieceIndex,
  kNotFound,
  kUploadExists,
  kRequestIdReused,
  kNotDurable,
  kVolumeMissing,
  kVolumeInUse,
  kUploadFinished,
  kJobNotSucceeded,
  kSecondWriter,
  kSenderTimeout,
  kReaderTimeout,
  kVolumeTooLarge,
  kShellPointsTooLarge,
  kDiskFull,
  kQueueFull,
  kMemoryBusy,
  kDecoderBusy,
  kDraining,
  kUnavailable,
  kStoredDataDamaged,
  kTokenMissing,
  kTokenInvalid,
  kAdminOnly,
  kCancelled,
  kDeadlineExceeded,
  kPoisoned,
  kServerDefect,
};

// What an error says besides reason and message; empty where it says nothing.
struct ErrorDetails {
  std::string field = {};  // that is wrong: its path in the request
  std::string quota = {};  // that is used up: the limit as ServerLimits or Durability name it
  std::string key = {};    // of one piece of metadata
  std::string value = {};
};

// An error that states its reason. It has the reason's code. The reason travels as a payload, also
// through the job store; calls/status_mapping.h turns it into the messages that callers get.
absl::Status CallError(Reason reason, const std::string& message, const ErrorDetails& details = {});

// INVALID_ARGUMENT: "<field>: <description>".
absl::Status InvalidField(const std::string& field, const std::string& description);
// INVALID_ARGUMENT: the bytes of a volume are not what they should be.
absl::Status InvalidVolume(const std::string& message);
// OUT_OF_RANGE: the caller should go on from `committed_bytes`.
absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes);
// RESOURCE_EXHAUSTED: `quota` is a limit of disk space that is used up.
absl::Status DiskFull(const std::string& message, const std::string& quota);

// Whether the status says why, be it that proto/wire found the error.
bool StatesReason(const absl::Status& status);
// Empty where it was not CallError() that made the status.
std::optional<Reason> ReasonOf(const absl::Status& status);
ErrorDetails DetailsOf(const absl::Status& status);
// What a caller whose offset was wrong should go on from.
std::optional<uint64_t> CommittedSizeOf(const absl::Status& status);

// "FIELD_INVALID", ...
const char* NameOf(Reason reason);
bool IsWorthARetry(Reason reason);

// The reason of an error that states none. Wrong arguments all state one: who finds them knows
// which they are.
Reason DefaultReason(absl::StatusCode code);

// An error with which a job has ended. Where it states no reason, a wrong argument is one in the
// volume's bytes, and too much of something is a volume over a limit that only decoding has shown.
absl::Status WithJobReason(const absl::Status& status);
// An error of the disk: where it states no reason, a full one is DISK_FULL; its message names
// files.
absl::Status WithDiskReason(const absl::Status& status);
// The same error; its message begins with `what`.
absl::Status Prefixed(const std::string& what, const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_
