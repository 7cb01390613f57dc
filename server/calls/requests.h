#ifndef BCCSKEL_SERVER_CALLS_REQUESTS_H_
#define BCCSKEL_SERVER_CALLS_REQUESTS_H_

#include <cstdint>
#include <string>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "bccskel/v1/volume.pb.h"
#include "core/io/volume_header.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Reads the first request of a stream. The deadline is left to the caller.
// Errors: INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED with the limit, for a volume declared
//         over `limits`.
absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits);

// Reads the first request of a stream of labels. The deadline is left to the caller.
// Errors: as JobRequestOf().
absl::StatusOr<LabelsRequest> JobRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                           const VolumeLimits& limits);

// Threads that a caller wants, in this field of its request. Errors: INVALID_ARGUMENT.
absl::Status CheckThreads(int32_t threads, const std::string& field);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_REQUESTS_H_
