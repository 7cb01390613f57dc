#ifndef BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_
#define BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// Why calls and jobs fail, as callers see it: here, as ERRORS.md describes it, its code, and
// whether another try is worth while.
#define BCCSKEL_REASONS(X)                                                   \
  X(kFieldInvalid, "FIELD_INVALID", kInvalidArgument, kNo)                   \
  X(kVolumeInvalid, "VOLUME_INVALID", kInvalidArgument, kNo)                 \
  X(kVolumeSize, "VOLUME_SIZE", kInvalidArgument, kNo)                       \
  X(kVolumeTruncated, "VOLUME_TRUNCATED", kInvalidArgument, kNo)             \
  X(kRequestOrder, "REQUEST_ORDER", kInvalidArgument, kNo)                   \
  X(kRequestMalformed, "REQUEST_MALFORMED", kInvalidArgument, kNo)           \
  X(kChunkChecksum, "CHUNK_CHECKSUM", kInvalidArgument, kNo)                 \
  X(kChunkOffset, "CHUNK_OFFSET", kOutOfRange, kNo)                          \
  X(kPieceIndex, "PIECE_INDEX", kOutOfRange, kNo)                            \
  X(kNotFound, "NOT_FOUND", kNotFound, kNo)                                  \
  X(kUploadExists, "UPLOAD_EXISTS", kAlreadyExists, kNo)                     \
  X(kRequestIdReused, "REQUEST_ID_REUSED", kAlreadyExists, kNo)              \
  X(kNotDurable, "NOT_DURABLE", kFailedPrecondition, kNo)                    \
  X(kVolumeMissing, "VOLUME_MISSING", kFailedPrecondition, kNo)              \
  X(kVolumeInUse, "VOLUME_IN_USE", kFailedPrecondition, kNo)                 \
  X(kUploadFinished, "UPLOAD_FINISHED", kFailedPrecondition, kNo)            \
  X(kJobNotSucceeded, "JOB_NOT_SUCCEEDED", kFailedPrecondition, kNo)         \
  X(kSecondWriter, "SECOND_WRITER", kAborted, kNo)                           \
  X(kSenderTimeout, "SENDER_TIMEOUT", kAborted, kNo)                         \
  X(kReaderTimeout, "READER_TIMEOUT", kAborted, kNo)                         \
  X(kVolumeTooLarge, "VOLUME_TOO_LARGE", kResourceExhausted, kNo)            \
  X(kShellPointsTooLarge, "SHELL_POINTS_TOO_LARGE", kResourceExhausted, kNo) \
  X(kDiskFull, "DISK_FULL", kResourceExhausted, kNo)                         \
  X(kQueueFull, "QUEUE_FULL", kUnavailable, kYes)                            \
  X(kMemoryBusy, "MEMORY_BUSY", kUnavailable, kYes)                          \
  X(kDecoderBusy, "DECODER_BUSY", kUnavailable, kYes)                        \
  X(kDraining, "DRAINING", kUnavailable, kYes)                               \
  X(kUnavailable, "UNAVAILABLE", kUnavailable, kNo)                          \
  X(kStoredDataDamaged, "STORED_DATA_DAMAGED", kDataLoss, kNo)               \
  X(kTokenMissing, "TOKEN_MISSING", kUnauthenticated, kNo)                   \
  X(kTokenInvalid, "TOKEN_INVALID", kUnauthenticated, kNo)                   \
  X(kAdminOnly, "ADMIN_ONLY", kPermissionDenied, kNo)                        \
  X(kCancelled, "CANCELLED", kCancelled, kNo)                                \
  X(kDeadlineExceeded, "DEADLINE_EXCEEDED", kDeadlineExceeded, kNo)          \
  X(kPoisoned, "POISONED", kInternal, kNo)                                   \
  X(kServerDefect, "SERVER_DEFECT", kInternal, kNo)

enum class Reason : uint8_t {
#define BCCSKEL_REASON(reason, ...) reason,
  BCCSKEL_REASONS(BCCSKEL_REASON)
#undef BCCSKEL_REASON
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
