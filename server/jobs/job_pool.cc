#include "server/jobs/job_pool.h"

#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "server/admission/demand.h"
#include "server/admission/refusal.h"
#include "server/jobs/labels_work.h"
#include "server/jobs/skeletonize_work.h"

namespace bccskel::server {
namespace {

// Decoding is several times faster than a connection brings bytes; two threads keep a job with a
// slow decoder from holding up the others' uploads.
constexpr int kDecoderThreads = 2;

absl::Status CheckSize(uint64_t size_bytes, uint64_t max_volume_bytes) {
  if (size_bytes <= max_volume_bytes) return absl::OkStatus();
  return Refuse(Refusal::kVolumeTooLarge,
                absl::StrFormat("the declared volume has %d bytes, the limit is %d", size_bytes,
                                max_volume_bytes));
}

}  // namespace

JobPool::JobPool(const Limits& limits)
    : limits_(limits),
      admission_({.bytes = limits.max_bytes, .places = limits.max_jobs + limits.max_queue}),
      compute_(limits.threads, limits.max_jobs),
      decoders_(kDecoderThreads) {}

absl::StatusOr<std::shared_ptr<Job>> JobPool::Start(JobRequest request,
                                                    std::shared_ptr<JobListener> listener) {
  BCCSKEL_RETURN_IF_ERROR(CheckSize(request.size_bytes, limits_.max_volume_bytes));
  BCCSKEL_ASSIGN_OR_RETURN(
      Ticket ticket, admission_.Admit(BytesToSkeletonize(request.header, request.size_bytes)));
  const auto deadline = request.deadline;
  return Launch(std::make_unique<SkeletonizeWork>(std::move(request), limits_.volume, listener),
                std::move(ticket), deadline, listener);
}

absl::StatusOr<std::shared_ptr<Job>> JobPool::Start(LabelsRequest request,
                                                    std::shared_ptr<LabelsListener> listener) {
  BCCSKEL_RETURN_IF_ERROR(CheckSize(request.size_bytes, limits_.max_volume_bytes));
  const int threads = ThreadsWithin(limits_.threads, request.threads_wanted);
  BCCSKEL_ASSIGN_OR_RETURN(Ticket ticket,
                           admission_.Admit(BytesToSkeletonizeLabels(request.header, threads)));
  const auto deadline = request.deadline;
  return Launch(std::make_unique<LabelsWork>(std::move(request), limits_.volume, threads, listener),
                std::move(ticket), deadline, listener);
}

std::shared_ptr<Job> JobPool::Launch(std::unique_ptr<JobWork> work, Ticket ticket,
                                     PoolJob::Clock::time_point deadline,
                                     std::shared_ptr<UploadListener> listener) {
  return std::make_shared<PoolJob>(absl::StrFormat("jobs/%d", next_job_++), std::move(work),
                                   std::move(ticket), deadline, std::move(listener), decoders_,
                                   compute_);
}

}  // namespace bccskel::server
