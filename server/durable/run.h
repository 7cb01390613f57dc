#ifndef BCCSKEL_SERVER_DURABLE_RUN_H_
#define BCCSKEL_SERVER_DURABLE_RUN_H_

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/status_macros.h"
#include "core/io/volume_digest.h"
#include "server/durable/flow.h"
#include "server/durable/records.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

class Run;

// Receives news of runs. Called on the runner's threads; must not block.
class RunObserver {
 public:
  virtual ~RunObserver() = default;
  virtual Flow OnRunVolume(std::shared_ptr<Run> run, std::string volume_digest) = 0;
  // New progress is ready for TakeProgress().
  virtual Flow OnRunProgress(std::shared_ptr<Run> run) = 0;
  // Called once, last.
  virtual Flow OnRunEnd(std::shared_ptr<Run> run, absl::StatusOr<JobResult> result) = 0;
};

// One computation at the runner, for one or more equal jobs. Its bytes come from an upload in
// progress or from a file.
// Threads: safe.
class Run : public JobListener, public std::enable_shared_from_this<Run> {
 public:
  // Needs: the observer outlives `operation`.
  Run(RunObserver& observer, std::string tenant, Operations::Token operation)
      : observer_(observer), tenant_(std::move(tenant)), operation_(std::move(operation)) {}

  const std::string& tenant() const { return tenant_; }

  // Asks the runner for a place. Errors: the runner's; the run is then of no further use.
  absl::Status Start(JobRunner& runner, JobRequest request) {
    BCCSKEL_ASSIGN_OR_RETURN(job_, runner.Start(std::move(request), shared_from_this()));
    return absl::OkStatus();
  }

  // The next bytes. `room` is called once they are decoded, or with the error that ended the run.
  // Needs: the last `room` has been called.
  void Append(std::string bytes, std::function<void(absl::Status)> room) {
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
  void FinishVolume() { job_->FinishVolume(std::nullopt); }

  // Ends the run soon; OnRunEnd() is still called.
  void Cancel() {
    cancelled_ = true;
    job_->Cancel();
  }
  // Whether Cancel() was called: a result that arrives later is not wanted.
  bool cancelled() const { return cancelled_; }
  // Ends the run because its bytes are unavailable.
  void Fail(absl::Status status) { job_->EndWith(std::move(status)); }

  std::optional<JobProgress> TakeProgress() {
    std::lock_guard lock(mutex_);
    announced_ = false;
    return std::exchange(progress_, std::nullopt);
  }

  void OnBytesConsumed() override {
    std::function<void(absl::Status)> room;
    {
      std::lock_guard lock(mutex_);
      room = std::exchange(room_, nullptr);
    }
    if (room) room(absl::OkStatus());
  }
  void OnVolume(const Volume& volume) override {
    observer_.OnRunVolume(shared_from_this(), VolumeDigest(volume));
  }
  void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) override {
    {
      std::lock_guard lock(mutex_);
      progress_ = JobProgress{.shell = progress, .elapsed = elapsed};
      if (announced_ || elapsed < next_announcement_) return;
      next_announcement_ = elapsed + kProgressInterval;
      announced_ = true;
    }
    observer_.OnRunProgress(shared_from_this());
  }
  void OnEnd(absl::StatusOr<JobResult> result) override {
    std::function<void(absl::Status)> room;
    bool unannounced = false;
    {
      std::lock_guard lock(mutex_);
      ended_ = true;
      room = std::exchange(room_, nullptr);
      unannounced = progress_.has_value() && !announced_;
    }
    // Copied, because the result moves to another thread.
    const absl::Status status(result.status().code(), result.status().message());
    if (unannounced) observer_.OnRunProgress(shared_from_this());
    // The observer learns of the end before the sender does.
    observer_.OnRunEnd(shared_from_this(), std::move(result));
    if (room) room(status);
  }

 private:
  RunObserver& observer_;
  const std::string tenant_;
  const Operations::Token operation_;
  std::shared_ptr<Job> job_;  // set by Start()
  std::atomic<bool> cancelled_{false};

  std::mutex mutex_;
  bool ended_ = false;                             // guarded by mutex_
  std::function<void(absl::Status)> room_;         // guarded by mutex_
  std::optional<JobProgress> progress_;            // guarded by mutex_
  std::chrono::nanoseconds next_announcement_{0};  // guarded by mutex_
  bool announced_ = false;                         // guarded by mutex_: progress not taken yet
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_RUN_H_
