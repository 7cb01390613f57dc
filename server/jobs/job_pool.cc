#include "server/jobs/job_pool.h"

#include <malloc.h>

#include <algorithm>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "server/admission/memory_estimate.h"
#include "server/decoding/child_pool.h"
#include "server/errors/call_error.h"
#include "server/jobs/job_work.h"
#include "server/jobs/names.h"
#include "server/jobs/pool_job.h"

namespace bccskel::server {
namespace {

// Decoding is several times faster than a connection delivers bytes; two threads keep a job with a
// slow decoder from blocking the uploads of others.
constexpr int kDecoderThreads = 2;

}  // namespace

absl::Status JobPool::Limits::CheckVolumeBytes(uint64_t size_bytes) const {
  if (size_bytes <= max_volume_bytes) return absl::OkStatus();
  return CallError(Reason::kVolumeTooLarge,
                   absl::StrFormat("the declared volume has %d bytes, the limit is %d", size_bytes,
                                   max_volume_bytes),
                   {.quota = "max_volume_bytes"});
}

JobPool::JobPool(const Limits& limits, JobObserver observer)
    : limits_(limits),
      observer_(std::move(observer)),
      admission_({.bytes = limits.max_bytes,
                  .places = limits.max_jobs + limits.max_queue,
                  .tenants = limits.tenants},
                 [] { malloc_trim(0); }),
      compute_(limits.threads, limits.max_jobs, limits.tenants),
      children_(limits.child_command.empty() ? nullptr
                                             : std::make_unique<ChildPool>(limits.child_command)),
      decoders_(kDecoderThreads, limits.tenants),
      finishers_(std::max(kDecoderThreads, limits.threads), limits.tenants) {}

absl::StatusOr<std::shared_ptr<Job>> JobPool::Start(JobRequest request,
                                                    std::shared_ptr<JobListener> listener) {
  const uint64_t bytes =
      BytesToSkeletonize(request.header, request.size_bytes, request.shell_points);
  TaskThreads& finishers = InChild(request.header) ? finishers_ : decoders_;
  return Launch(request, bytes, finishers, listener, [&] {
    VolumeReceiver::MakeDecoder make_decoder = DecoderFor(request);
    return MakeSkeletonizeWork(std::move(request), limits_.volume, std::move(make_decoder),
                               listener);
  });
}

absl::StatusOr<std::shared_ptr<Job>> JobPool::Start(LabelsRequest request,
                                                    std::shared_ptr<LabelsListener> listener) {
  const int threads = ThreadsWithin(limits_.threads, request.threads_wanted);
  const uint64_t bytes = BytesToSkeletonizeLabels(request.header, threads);
  return Launch(request, bytes, decoders_, listener, [&] {
    return MakeLabelsWork(std::move(request), limits_.volume, threads, listener);
  });
}

// `make_work` may move from the request that `wish` is a part of.
template <typename MakeWork>
absl::StatusOr<std::shared_ptr<Job>> JobPool::Launch(const JobWish& wish, uint64_t bytes,
                                                     TaskThreads& finishers,
                                                     std::shared_ptr<UploadListener> listener,
                                                     MakeWork make_work) {
  BCCSKEL_RETURN_IF_ERROR(limits_.CheckVolumeBytes(wish.size_bytes));
  BCCSKEL_ASSIGN_OR_RETURN(Ticket ticket,
                           admission_.Admit(wish.origin.tenant, std::max(bytes, wish.min_bytes)));
  observer_.on_admitted(wish.size_bytes);
  PoolJobFacts facts = {RandomName("jobs"), wish.origin, wish.deadline, wish.min_bytes, observer_};
  return MakePoolJob(std::move(facts), make_work(), std::move(ticket), std::move(listener),
                     PoolJobThreads{decoders_, finishers, compute_});
}

void JobPool::SetTenants(const TenantTable& tenants) {
  admission_.SetTenants(tenants);
  compute_.SetTenants(tenants);
  decoders_.SetTenants(tenants);
  finishers_.SetTenants(tenants);
}

bool JobPool::InChild(const VolumeHeader& header) const {
  return children_ != nullptr && header.encoding == VolumeEncoding::kOpenExr;
}

VolumeReceiver::MakeDecoder JobPool::DecoderFor(const JobRequest& request) {
  if (!InChild(request.header)) return &MakeVolumeDecoder;
  return [tenant = request.origin.tenant, &children = *children_](const VolumeHeader& header,
                                                                  const VolumeLimits& limits) {
    return MakeChildDecoder(header, limits, tenant, children);
  };
}

}  // namespace bccskel::server
