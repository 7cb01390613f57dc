#ifndef BCCSKEL_SERVER_CALLS_JOB_REQUEST_H_
#define BCCSKEL_SERVER_CALLS_JOB_REQUEST_H_

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Reads the first request of a stream. The deadline is left to the caller.
// Errors: INVALID_ARGUMENT with the field; RESOURCE_EXHAUSTED with the limit, for a volume declared
//         over `limits`.
absl::StatusOr<JobRequest> JobRequestOf(const v1::SkeletonizeConfig& config,
                                        const VolumeLimits& limits);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_JOB_REQUEST_H_
