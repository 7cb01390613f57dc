#ifndef BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_
#define BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_

#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"

namespace bccskel::server {

// The reasons why calls and jobs fail: name, text (see ERRORS.md), status code, and whether a retry
// is worthwhile.
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

// Further details of an error; empty if unused.
struct ErrorDetails {
  std::string field = {};  // path of the wrong field in the request
  std::string quota = {};  // the exhausted limit, named as in ServerLimits or Durability
  std::string key = {};    // of one piece of metadata
  std::string value = {};
};

// An error that states its reason, with the reason's code. The reason travels as a payload, also
// through the job store; calls/status_mapping.h converts it to the messages that callers get.
absl::Status CallError(Reason reason, const std::string& message, const ErrorDetails& details = {});

// INVALID_ARGUMENT: "<field>: <description>".
absl::Status InvalidField(const std::string& field, const std::string& description);
// INVALID_ARGUMENT: the bytes of a volume are malformed.
absl::Status InvalidVolume(const std::string& message);
// OUT_OF_RANGE: the caller should resume at `committed_bytes`, the detail "committed_size".
absl::Status WrongOffset(const std::string& message, uint64_t committed_bytes);
// UNAVAILABLE: the job would need `needed_bytes` of memory in all.
absl::Status MemoryBusy(const std::string& message, uint64_t needed_bytes);
// RESOURCE_EXHAUSTED: the disk space limit `quota` is used up, or "disk", the disk itself.
absl::Status DiskFull(const std::string& message, const std::string& quota);

// CANCELLED: by a call that asked for it.
absl::Status JobCancelled();

// Whether the status states a reason, from CallError() or from proto/wire.
bool StatesReason(const absl::Status& status);
// nullopt unless CallError() made the status.
std::optional<Reason> ReasonOf(const absl::Status& status);
ErrorDetails DetailsOf(const absl::Status& status);
// The memory that a job needs which found too little of it.
std::optional<uint64_t> NeededBytesOf(const absl::Status& status);

// "FIELD_INVALID", ...
const char* NameOf(Reason reason);
bool IsWorthARetry(Reason reason);

// The reason for an error that states none. Invalid arguments always state one, because only the
// code that finds them knows which.
Reason DefaultReason(absl::StatusCode code);

// Adds a reason to an error that ended a job, if it states none: an invalid argument means invalid
// volume bytes, and an exhausted resource a volume over a limit that only decoding has revealed.
absl::Status WithJobReason(const absl::Status& status);
// Adds a reason to a disk error, if it states none: a full disk is DISK_FULL with the quota `disk`.
// The message names files.
absl::Status WithDiskReason(const absl::Status& status);
// The same error with `what` before its message.
absl::Status Prefixed(const std::string& what, const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_ERRORS_CALL_ERROR_H_
