#include <utility>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_encoder.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/prepare/fill_cavities.h"
#include "core/volume/volume.h"
#include "server/admission/memory_estimate.h"
#include "server/errors/call_error.h"
#include "server/jobs/job_work.h"

namespace bccskel::server {
namespace {

absl::StatusOr<std::string> EncodeThin(const Volume& thin, VolumeEncoding encoding,
                                       const exec::Context& context) {
  const VolumeCompression compression =
      encoding == VolumeEncoding::kOpenExr ? VolumeCompression::kRle : VolumeCompression::kNone;
  return EncodeVolume(thin, {.encoding = encoding, .compression = compression}, context);
}

// Computes the skeleton of one volume in one turn.
class SkeletonizeWork final : public JobWork {
 public:
  SkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                  VolumeReceiver::MakeDecoder make_decoder, std::shared_ptr<JobListener> listener)
      : request_(std::move(request)),
        listener_(std::move(listener)),
        receiver_(std::make_unique<VolumeReceiver>(request_.header, request_.size_bytes, limits,
                                                   std::move(make_decoder))) {}

  absl::Status Append(std::string_view bytes, const exec::Context&) override {
    return receiver_->Append(bytes);
  }
  absl::Status Finish(const std::optional<Sha256Digest>& expected,
                      const exec::Context& context) override {
    BCCSKEL_ASSIGN_OR_RETURN(volume_, receiver_->Finish(expected, context));
    mask_topology_ = receiver_->mask_topology();
    receiver_.reset();
    listener_->OnVolume(*volume_);
    return CountBricks(context);
  }
  uint64_t BytesToRun() const override {
    const uint64_t more = bricks_ - volume_->brick_count();
    return BytesToSkeletonize(*volume_, request_.shell_points) + more * kPipelineBytesPerBrick +
           ShellPointsBytes(request_.shell_points, more);
  }
  int MostThreads(int threads) const override {
    return ThreadsFor(bricks_, request_.threads_wanted, threads);
  }
  uint64_t Bricks() const override { return volume_->brick_count(); }
  absl::StatusOr<JobWork::Turn> Run(exec::Context context,
                                    const std::shared_ptr<exec::MemoryBudget>& memory,
                                    const std::function<void()>&) override {
    const auto start = exec::Context::Clock::now();
    context.on_shell = [this, start](const exec::ShellProgress& progress) {
      listener_->OnShell(progress, exec::Context::Clock::now() - start);
    };
    SkeletonizeOptions options = request_.options;
    // Denoising may close a cavity that was open when the memory was reserved.
    options.preparing.max_bricks = 2 * bricks_;
    BCCSKEL_ASSIGN_OR_RETURN(result_.skeleton, SkeletonizeWithin(*memory, *volume_, options,
                                                                 context, ShellPointsCallback()));
    BCCSKEL_RETURN_IF_ERROR(CheckShellPoints());
    result_.skeleton.certificate.mask = mask_topology_;
    if (request_.thin_volume.has_value()) {
      BCCSKEL_ASSIGN_OR_RETURN(result_.thin_volume,
                               EncodeThin(result_.skeleton.thin, *request_.thin_volume, context));
    }
    result_.skeleton.thin = Volume();
    result_.threads = context.threads();
    return Turn::kDone;
  }
  uint64_t ObjectPoints() const override { return result_.skeleton.object_points; }
  void End(absl::Status status, const JobTimes& times, Ticket ticket) override {
    const std::shared_ptr<JobListener> listener = std::move(listener_);
    JobResult result = std::exchange(result_, JobResult());
    volume_.reset();
    receiver_.reset();
    if (!status.ok()) {
      result = JobResult();
      ticket = Ticket();
      return listener->OnEnd(std::move(status));
    }
    ticket.LeavePlace();
    ticket.ShrinkTo(GraphBytes(result.skeleton.graph) + result.thin_volume.size() +
                    shell_points_bytes_);
    result.times = times;
    result.ticket = std::move(ticket);
    listener->OnEnd(std::move(result));
  }

 private:
  // Cavities may hold far more bricks than the object.
  absl::Status CountBricks(const exec::Context& context) {
    bricks_ = volume_->brick_count();
    if (request_.options.preparing.cavities == CavityFilling::kOff) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(bricks_, BricksWithCavitiesFilled(*volume_, context));
    return absl::OkStatus();
  }
  // Stops passing on points once they exceed the reserved memory.
  OnShellPoints ShellPointsCallback() {
    if (request_.shell_points == ShellPointsWanted::kNone) return nullptr;
    const uint64_t limit = ShellPointsBytes(request_.shell_points, bricks_);
    return [this, limit](int32_t shell, const Volume& points) {
      if (shell_points_bytes_ > limit) return;
      shell_points_bytes_ += listener_->OnShellPoints(shell, points);
    };
  }
  absl::Status CheckShellPoints() const {
    const uint64_t limit = ShellPointsBytes(request_.shell_points, bricks_);
    if (shell_points_bytes_ <= limit) return absl::OkStatus();
    return CallError(Reason::kShellPointsTooLarge,
                     absl::StrCat("the shell points need more than ", limit,
                                  " bytes, the limit for a volume of ", bricks_, " bricks"));
  }

  const JobRequest request_;
  std::shared_ptr<JobListener> listener_;
  std::unique_ptr<VolumeReceiver> receiver_;
  std::optional<Volume> volume_;
  uint64_t bricks_ = 0;  // of the volume, with filled cavities if requested
  std::optional<BettiNumbers> mask_topology_;
  JobResult result_;
  uint64_t shell_points_bytes_ = 0;  // passed to the listener
};

}  // namespace

std::unique_ptr<JobWork> MakeSkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                                             VolumeReceiver::MakeDecoder make_decoder,
                                             std::shared_ptr<JobListener> listener) {
  return std::make_unique<SkeletonizeWork>(std::move(request), limits, std::move(make_decoder),
                                           std::move(listener));
}

}  // namespace bccskel::server
