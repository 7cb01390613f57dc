#ifndef BCCSKEL_SERVER_JOBS_POOL_JOB_H_
#define BCCSKEL_SERVER_JOBS_POOL_JOB_H_

#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "server/jobs/compute_queue.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/task_threads.h"
#include "server/jobs/volume_intake.h"

namespace bccskel::server {

// A job of a JobPool: receives its volume piece by piece, each decoded on a decoder thread, then
// waits for its turn and is computed. At any time at most one task of a job exists, so that its
// volume needs no lock; the mutex guards what callers and that task share.
//
//   kReceiving --Append, FinishVolume--> kDecoding --> kReceiving | kWaiting --> kRunning -->
//   kEnded
//
// Cancel() asks the task to stop; where there is none (kReceiving, kWaiting) it posts one that ends
// the job.
class PoolJob : public Job, public std::enable_shared_from_this<PoolJob> {
 public:
  // Needs: decoders and compute outlive the job.
  PoolJob(std::string name, JobRequest request, Ticket ticket, const VolumeLimits& limits,
          std::shared_ptr<JobListener> listener, TaskThreads& decoders, ComputeQueue& compute);

  const std::string& name() const override { return name_; }
  void Append(std::string bytes) override;
  void FinishVolume(std::optional<Sha256Digest> expected) override;
  void Cancel() override;

 private:
  using Clock = exec::Context::Clock;
  enum class Phase { kReceiving, kDecoding, kWaiting, kRunning, kEnded };

  // False when the job was cancelled meanwhile and the caller has nothing to do.
  bool Enter(Phase from, Phase to);
  void Decode(const std::string& bytes);
  void DecodeRest(const std::optional<Sha256Digest>& expected);
  void WaitForTurn();
  void Run(int threads);
  void End(absl::StatusOr<JobResult> result);
  exec::Context DecodeContext() const;
  absl::Status StopStatus() const;

  const std::string name_;
  const JobRequest request_;
  TaskThreads& decoders_;
  ComputeQueue& compute_;
  std::stop_source stop_;

  // Owned by the one task that exists.
  Ticket ticket_;
  std::unique_ptr<VolumeIntake> intake_;
  std::optional<Volume> volume_;
  std::optional<BettiNumbers> mask_topology_;
  std::chrono::nanoseconds decoded_{0};
  Clock::time_point waiting_since_;

  std::mutex mutex_;
  Phase phase_ = Phase::kReceiving;        // guarded by mutex_
  ComputeQueue::Entry entry_ = 0;          // guarded by mutex_; valid in kWaiting
  std::shared_ptr<JobListener> listener_;  // guarded by mutex_; null once ended
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_POOL_JOB_H_
