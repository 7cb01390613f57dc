#include "server/jobs/run_skeletonize.h"

#include <utility>

#include "core/exec/status_macros.h"
#include "core/exec/worker_team.h"
#include "core/io/volume_encoder.h"
#include "server/jobs/out_of_memory.h"

namespace bccskel::server {
namespace {

absl::StatusOr<std::string> EncodeThin(const Volume& thin, VolumeEncoding encoding,
                                       const exec::Context& context) {
  const VolumeCompression compression =
      encoding == VolumeEncoding::kOpenExr ? VolumeCompression::kRle : VolumeCompression::kNone;
  return EncodeVolume(thin, {.encoding = encoding, .compression = compression}, context);
}

absl::StatusOr<JobResult> Run(const Volume& volume, const JobRequest& request,
                              const exec::Context& context) {
  JobResult result;
  BCCSKEL_ASSIGN_OR_RETURN(result.skeleton, Skeletonize(volume, request.options, context));
  if (request.thin_volume.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(result.thin_volume,
                             EncodeThin(result.skeleton.thin, *request.thin_volume, context));
  }
  result.skeleton.thin = Volume();
  result.threads = context.threads();
  return result;
}

}  // namespace

absl::StatusOr<JobResult> RunSkeletonize(const Volume& volume, const JobRequest& request,
                                         int threads, std::stop_token stop,
                                         const ShellListener& on_shell) {
  return OrOutOfMemory([&]() -> absl::StatusOr<JobResult> {
    exec::WorkerTeam team(threads);
    const auto start = exec::Context::Clock::now();
    return Run(volume, request,
               {.team = &team,
                .stop = std::move(stop),
                .deadline = request.deadline,
                .on_shell = [&on_shell, start](const exec::ShellProgress& progress) {
                  on_shell(progress, exec::Context::Clock::now() - start);
                }});
  });
}

}  // namespace bccskel::server
