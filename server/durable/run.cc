#include "server/durable/run.h"

#include <utility>

#include "core/exec/status_macros.h"
#include "core/io/volume_digest.h"

namespace bccskel::server {
namespace {

// Progress that is told more often would cost the computation time.
constexpr std::chrono::milliseconds kProgressInterval(2);

}  // namespace

absl::Status Run::Start(JobRunner& runner, JobRequest request) {
  BCCSKEL_ASSIGN_OR_RETURN(job_, runner.Start(std::move(request), shared_from_this()));
  return absl::OkStatus();
}

void Run::Append(std::string bytes, std::function<void(absl::Status)> room) {
  {
    std::unique_lock lock(mutex_);
    if (ended_) {
      lock.unlock();
      return room(absl::CancelledError("the run has ended"));
    }
    room_ = std::move(room);
  }
  job_->Append(std::move(bytes));
}

void Run::FinishVolume() { job_->FinishVolume(std::nullopt); }

void Run::Cancel() {
  cancelled_ = true;
  job_->Cancel();
}

std::optional<JobProgress> Run::TakeProgress() {
  std::lock_guard lock(mutex_);
  announced_ = false;
  return std::exchange(progress_, std::nullopt);
}

void Run::OnBytesConsumed() {
  std::function<void(absl::Status)> room;
  {
    std::lock_guard lock(mutex_);
    room = std::exchange(room_, nullptr);
  }
  if (room) room(absl::OkStatus());
}

void Run::OnVolume(const Volume& volume) {
  observer_.OnRunVolume(shared_from_this(), VolumeDigest(volume));
}

void Run::OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) {
  {
    std::lock_guard lock(mutex_);
    progress_ = JobProgress{.shell = progress, .elapsed = elapsed};
    if (announced_ || elapsed < next_announcement_) return;
    next_announcement_ = elapsed + kProgressInterval;
    announced_ = true;
  }
  observer_.OnRunProgress(shared_from_this());
}

void Run::OnEnd(absl::StatusOr<JobResult> result) {
  std::function<void(absl::Status)> room;
  bool unannounced = false;
  {
    std::lock_guard lock(mutex_);
    ended_ = true;
    room = std::exchange(room_, nullptr);
    unannounced = progress_.has_value() && !announced_;
  }
  // A copy of its own: the result goes to another thread.
  const absl::Status status(result.status().code(), result.status().message());
  if (unannounced) observer_.OnRunProgress(shared_from_this());
  // The run's end is known before the sender hears of it.
  observer_.OnRunEnd(shared_from_this(), std::move(result));
  if (room) room(status);
}

}  // namespace bccskel::server
