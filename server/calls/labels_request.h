#ifndef BCCSKEL_SERVER_CALLS_LABELS_REQUEST_H_
#define BCCSKEL_SERVER_CALLS_LABELS_REQUEST_H_

#include "absl/status/statusor.h"
#include "bccskel/v1/skeletonization_service.pb.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

// Reads the first request of a stream of labels. The deadline is left to the caller.
// Errors: as JobRequestOf().
absl::StatusOr<LabelsRequest> LabelsRequestOf(const v1::SkeletonizeLabelsConfig& config,
                                              const VolumeLimits& limits);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_LABELS_REQUEST_H_
