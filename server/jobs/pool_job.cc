#include "server/jobs/pool_job.h"

#include <algorithm>
#include <utility>

#include "server/admission/demand.h"
#include "server/jobs/out_of_memory.h"
#include "server/jobs/run_skeletonize.h"

namespace bccskel::server {
namespace {

// Memory that a finished result keeps while it is sent.
uint64_t BytesOf(const JobResult& result) {
  const SkeletonGraph& graph = result.skeleton.graph;
  return graph.nodes.size() * sizeof(SkeletonNode) + graph.edges.size() * sizeof(SkeletonEdge) +
         graph.points.size() * sizeof(SkeletonPoint) + result.thin_volume.size();
}

}  // namespace

PoolJob::PoolJob(std::string name, JobRequest request, Ticket ticket, const VolumeLimits& limits,
                 std::shared_ptr<JobListener> listener, TaskThreads& decoders,
                 ComputeQueue& compute)
    : name_(std::move(name)),
      request_(std::move(request)),
      decoders_(decoders),
      compute_(compute),
      ticket_(std::move(ticket)),
      intake_(std::make_unique<VolumeIntake>(request_.header, request_.size_bytes, limits)),
      listener_(std::move(listener)) {}

void PoolJob::Append(std::string bytes) {
  if (!Enter(Phase::kReceiving, Phase::kDecoding)) return;
  decoders_.Post([self = shared_from_this(), bytes = std::move(bytes)] { self->Decode(bytes); });
}

void PoolJob::FinishVolume(std::optional<Sha256Digest> expected) {
  if (!Enter(Phase::kReceiving, Phase::kDecoding)) return;
  decoders_.Post([self = shared_from_this(), expected] { self->DecodeRest(expected); });
}

void PoolJob::Cancel() {
  stop_.request_stop();
  {
    std::lock_guard lock(mutex_);
    const bool waits =
        phase_ == Phase::kWaiting && compute_.Remove(entry_) == ComputeQueue::Removal::kRemoved;
    if (phase_ != Phase::kReceiving && !waits) return;
    phase_ = Phase::kDecoding;
  }
  decoders_.Post([self = shared_from_this()] { self->End(self->StopStatus()); });
}

bool PoolJob::Enter(Phase from, Phase to) {
  std::lock_guard lock(mutex_);
  if (phase_ != from) return false;
  phase_ = to;
  return true;
}

exec::Context PoolJob::DecodeContext() const {
  return {.stop = stop_.get_token(), .deadline = request_.deadline, .on_shell = nullptr};
}

absl::Status PoolJob::StopStatus() const { return DecodeContext().StopStatus(); }

void PoolJob::Decode(const std::string& bytes) {
  const Clock::time_point start = Clock::now();
  absl::Status status = StopStatus();
  if (status.ok()) status = OrOutOfMemory([&] { return intake_->Append(bytes); });
  decoded_ += Clock::now() - start;
  if (status.ok()) status = StopStatus();
  if (!status.ok()) return End(std::move(status));
  std::shared_ptr<JobListener> listener;
  {
    // Whoever cancels sees either kDecoding, and the stop is seen here, or kReceiving.
    std::lock_guard lock(mutex_);
    if (!stop_.stop_requested()) {
      phase_ = Phase::kReceiving;
      listener = listener_;
    }
  }
  if (listener == nullptr) return End(StopStatus());
  listener->OnBytesConsumed();
}

void PoolJob::DecodeRest(const std::optional<Sha256Digest>& expected) {
  const Clock::time_point start = Clock::now();
  absl::Status status = StopStatus();
  if (status.ok()) {
    absl::StatusOr<Volume> volume =
        OrOutOfMemory([&] { return intake_->Finish(expected, DecodeContext()); });
    status = volume.status();
    if (volume.ok()) {
      volume_ = *std::move(volume);
      mask_topology_ = intake_->mask_topology();
    }
  }
  intake_.reset();
  decoded_ += Clock::now() - start;
  if (!status.ok()) return End(std::move(status));
  ticket_.ShrinkTo(BytesToSkeletonize(*volume_));
  WaitForTurn();
}

void PoolJob::WaitForTurn() {
  waiting_since_ = Clock::now();
  const int most_threads =
      ThreadsFor(volume_->brick_count(), request_.threads_wanted, compute_.threads());
  std::unique_lock lock(mutex_);
  if (stop_.stop_requested()) {
    lock.unlock();
    return End(StopStatus());
  }
  phase_ = Phase::kWaiting;
  entry_ =
      compute_.Post(most_threads, [self = shared_from_this()](int threads) { self->Run(threads); });
}

void PoolJob::Run(int threads) {
  std::shared_ptr<JobListener> listener;
  {
    std::lock_guard lock(mutex_);
    phase_ = Phase::kRunning;
    listener = listener_;
  }
  const auto queued = Clock::now() - waiting_since_;
  absl::StatusOr<JobResult> result = RunSkeletonize(
      *volume_, request_, threads, stop_.get_token(),
      [&listener](const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) {
        listener->OnShell(progress, elapsed);
      });
  if (result.ok()) {
    result->queued = queued;
    result->decoded = decoded_;
    result->skeleton.certificate.mask = mask_topology_;
  }
  End(std::move(result));
}

void PoolJob::End(absl::StatusOr<JobResult> result) {
  std::shared_ptr<JobListener> listener;
  bool cancelled = false;
  {
    std::lock_guard lock(mutex_);
    phase_ = Phase::kEnded;
    listener = std::move(listener_);
    cancelled = stop_.stop_requested();
  }
  if (cancelled && result.ok()) result = StopStatus();  // the last stage did not see it in time
  volume_.reset();
  intake_.reset();
  if (result.ok()) {
    ticket_.LeavePlace();
    ticket_.ShrinkTo(BytesOf(*result));
    result->ticket = std::move(ticket_);
  }
  ticket_ = Ticket();
  listener->OnEnd(std::move(result));
}

}  // namespace bccskel::server
