#ifndef BCCSKEL_SERVER_JOBS_RUN_SKELETONIZE_H_
#define BCCSKEL_SERVER_JOBS_RUN_SKELETONIZE_H_

#include <chrono>
#include <functional>
#include <stop_token>

#include "absl/status/statusor.h"
#include "core/volume/volume.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

using ShellListener =
    std::function<void(const exec::ShellProgress&, std::chrono::nanoseconds elapsed)>;

// Runs the pipeline on a team of `threads`, of which the caller is one. Queue and decode times and
// the ticket are left to the caller.
// Errors: as Skeletonize(); RESOURCE_EXHAUSTED when memory runs out. Nothing is thrown.
absl::StatusOr<JobResult> RunSkeletonize(const Volume& volume, const JobRequest& request,
                                         int threads, std::stop_token stop,
                                         const ShellListener& on_shell);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_RUN_SKELETONIZE_H_
