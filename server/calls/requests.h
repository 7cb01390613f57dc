#ifndef BCCSKEL_SERVER_CALLS_REQUESTS_H_
#define BCCSKEL_SERVER_CALLS_REQUESTS_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "absl/strings/str_cat.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"
#include "proto/wire/enumerators.h"
#include "server/errors/call_error.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Reads the first request of a stream. The caller sets the deadline.
// Errors: INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED with the limit, for a volume declared
//         over `limits`.
absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits);

// Reads the first request of a stream of labels. The caller sets the deadline.
// Errors: as JobRequestOf().
absl::StatusOr<LabelsRequest> JobRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                           const VolumeLimits& limits);

// What is stored of a declaration: its known fields.
std::string DeclarationBytes(v1::VolumeDeclaration volume);

// Checks the number of threads in this field of a request. Errors: INVALID_ARGUMENT.
absl::Status CheckThreads(int32_t threads, const std::string& field);

// What the sender states; nullopt: nothing.
inline std::optional<uint32_t> Crc32cOf(const v1::VolumeChunk& chunk) {
  return chunk.has_crc32c() ? std::optional(chunk.crc32c()) : std::nullopt;
}

// The meaning of an enumerator of the interface. `what` names its kind in the error for an unknown
// one. Errors: INVALID_ARGUMENT with the field.
template <typename Meaning, typename Enumerator, size_t kCount>
absl::StatusOr<Meaning> MeaningOf(Enumerator wanted, const std::string& field, const char* what,
                                  const std::pair<Enumerator, Meaning> (&known)[kCount]) {
  const std::optional<Meaning> meaning = wire::MeaningOf(wanted, known);
  if (meaning.has_value()) return *meaning;
  return InvalidField(field, absl::StrCat("unknown ", what, int{wanted}));
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_REQUESTS_H_
