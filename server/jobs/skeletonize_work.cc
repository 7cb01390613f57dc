#include "server/jobs/skeletonize_work.h"

#include <utility>

#include "core/exec/status_macros.h"
#include "core/io/volume_encoder.h"
#include "server/admission/demand.h"

namespace bccskel::server {
namespace {

absl::StatusOr<std::string> EncodeThin(const Volume& thin, VolumeEncoding encoding,
                                       const exec::Context& context) {
  const VolumeCompression compression =
      encoding == VolumeEncoding::kOpenExr ? VolumeCompression::kRle : VolumeCompression::kNone;
  return EncodeVolume(thin, {.encoding = encoding, .compression = compression}, context);
}

}  // namespace

SkeletonizeWork::SkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                                 VolumeIntake::MakeDecoder make_decoder,
                                 std::shared_ptr<JobListener> listener)
    : request_(std::move(request)),
      listener_(std::move(listener)),
      intake_(std::make_unique<VolumeIntake>(request_.header, request_.size_bytes, limits,
                                             std::move(make_decoder))) {}

absl::Status SkeletonizeWork::Append(std::string_view bytes, const exec::Context&) {
  return intake_->Append(bytes);
}

absl::Status SkeletonizeWork::Finish(const std::optional<Sha256Digest>& expected,
                                     const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(volume_, intake_->Finish(expected, context));
  mask_topology_ = intake_->mask_topology();
  intake_.reset();
  listener_->OnVolume(*volume_);
  return absl::OkStatus();
}

uint64_t SkeletonizeWork::BytesToRun() const { return BytesToSkeletonize(*volume_); }

int SkeletonizeWork::MostThreads(int threads) const {
  return ThreadsFor(volume_->brick_count(), request_.threads_wanted, threads);
}

absl::StatusOr<JobWork::Turn> SkeletonizeWork::Run(exec::Context context,
                                                   const std::function<void()>&) {
  const auto start = exec::Context::Clock::now();
  context.on_shell = [this, start](const exec::ShellProgress& progress) {
    listener_->OnShell(progress, exec::Context::Clock::now() - start);
  };
  BCCSKEL_ASSIGN_OR_RETURN(result_.skeleton, Skeletonize(*volume_, request_.options, context));
  result_.skeleton.certificate.mask = mask_topology_;
  if (request_.thin_volume.has_value()) {
    BCCSKEL_ASSIGN_OR_RETURN(result_.thin_volume,
                             EncodeThin(result_.skeleton.thin, *request_.thin_volume, context));
  }
  result_.skeleton.thin = Volume();
  result_.threads = context.threads();
  return Turn::kDone;
}

void SkeletonizeWork::End(const absl::Status& status, const JobTimes& times, Ticket ticket) {
  const std::shared_ptr<JobListener> listener = std::move(listener_);
  JobResult result = std::exchange(result_, JobResult());
  volume_.reset();
  intake_.reset();
  if (!status.ok()) {
    result = JobResult();
    ticket = Ticket();
    return listener->OnEnd(status);
  }
  ticket.LeavePlace();
  ticket.ShrinkTo(GraphBytes(result.skeleton.graph) + result.thin_volume.size());
  result.queued = times.queued;
  result.decoded = times.decoded;
  result.ticket = std::move(ticket);
  listener->OnEnd(std::move(result));
}

}  // namespace bccskel::server
