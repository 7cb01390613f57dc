#ifndef BCCSKEL_SERVER_JOBS_POOL_JOB_H_
#define BCCSKEL_SERVER_JOBS_POOL_JOB_H_

#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>

#include "server/jobs/compute_queue.h"
#include "server/jobs/job_memory.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/job_work.h"
#include "server/jobs/task_threads.h"

namespace bccskel::server {

// A job of a JobPool: receives its volume piece by piece, each decoded on a decoder thread, then
// waits for its turn and is computed, in as many turns as its work wants. At any time at most one
// task of a job exists, so that its work needs no lock; the mutex guards what callers and that task
// share.
//
//   kReceiving --Append, FinishVolume--> kDecoding --> kReceiving | kPaused
//   kPaused --as soon as the work may run--> kWaiting --> kRunning --> kPaused | kEnded
//
// EndWith() asks the task to stop; where there is none (kReceiving, kPaused, kWaiting) it posts one
// that ends the job.
class PoolJob : public Job, public std::enable_shared_from_this<PoolJob> {
 public:
  using Clock = exec::Context::Clock;

  // Where jobs get their threads from.
  struct Threads {
    TaskThreads& decoders;
    TaskThreads& finishers;  // for the last of decoding, which may wait for a child
    ComputeQueue& compute;
  };
  struct Facts {
    std::string name;
    JobOrigin origin;
    Clock::time_point deadline;
    const JobObserver& observer;
  };

  // Needs: the threads and the observer outlive the job.
  PoolJob(Facts facts, std::unique_ptr<JobWork> work, Ticket ticket,
          std::shared_ptr<UploadListener> listener, const Threads& threads);

  const std::string& name() const override { return facts_.name; }
  void Append(std::string bytes) override;
  void FinishVolume(std::optional<Sha256Digest> expected) override;
  void EndWith(absl::Status why) override;

 private:
  enum class Phase { kReceiving, kDecoding, kPaused, kWaiting, kRunning, kEnded };

  // False when the job was cancelled meanwhile and the caller has nothing to do.
  bool Enter(Phase from, Phase to);
  void Decode(const std::string& bytes);
  void DecodeRest(const std::optional<Sha256Digest>& expected);
  // Runs a step of the decoder on the clock. Errors: the step's; when the job is to stop.
  template <typename Step>
  absl::Status OnDecoderClock(Step step);
  void WaitForTurn();
  void Wake();
  // Needs: mutex_ held.
  void PostIfReady();
  void Run(ComputeQueue::Turn& turn);
  absl::StatusOr<JobWork::Turn> RunTurn(ComputeQueue::Turn& turn);
  void End(absl::Status status);
  exec::Context StopContext() const;

  const Facts facts_;
  const Threads threads_;
  std::stop_source stop_;

  // Owned by the one task that exists.
  const std::unique_ptr<JobWork> work_;
  const std::shared_ptr<JobMemory> memory_;
  JobTimes times_;

  std::mutex mutex_;
  absl::Status why_;                          // guarded by mutex_; set before the stop is requested
  Phase phase_ = Phase::kReceiving;           // guarded by mutex_
  ComputeQueue::Entry entry_;                 // guarded by mutex_; valid in kWaiting
  Clock::time_point waiting_since_;           // guarded by mutex_; valid in kWaiting
  std::shared_ptr<UploadListener> listener_;  // guarded by mutex_; null once ended
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_POOL_JOB_H_
