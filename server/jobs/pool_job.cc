#include "server/jobs/pool_job.h"

#include <mutex>
#include <new>
#include <optional>
#include <stop_token>
#include <system_error>
#include <utility>

#include "absl/status/status.h"
#include "server/jobs/job_memory.h"

namespace bccskel::server {
namespace {

// Runs a step of a job. A failure to get memory or threads is the job's error and does not end the
// server.
template <typename Step>
auto OrOutOfMemory(Step step) -> decltype(step()) {
  try {
    return step();
  } catch (const std::bad_alloc&) {
    return absl::ResourceExhaustedError("out of memory although the job was admitted");
  } catch (const std::system_error& error) {
    return absl::ResourceExhaustedError(error.what());
  }
}

// At most one task of a job exists at any time, so its work needs no lock; the mutex guards what
// callers and that task share.
//
//    kReceiving --Append, FinishVolume--> kDecoding --> kReceiving | kPaused
//    kPaused --as soon as the work may run--> kWaiting --> kRunning --> kPaused | kEnded
//
// EndWith() asks the task to stop; if there is none (kReceiving, kPaused, kWaiting), it posts one
// that ends the job.
class PoolJob : public Job, public std::enable_shared_from_this<PoolJob> {
 public:
  using Clock = exec::Context::Clock;

  PoolJob(PoolJobFacts facts, std::unique_ptr<JobWork> work, Ticket ticket,
          std::shared_ptr<UploadListener> listener, const PoolJobThreads& threads)
      : facts_(std::move(facts)),
        threads_(threads),
        work_(std::move(work)),
        memory_(std::make_shared<JobMemory>(std::move(ticket), facts_.min_bytes)),
        listener_(std::move(listener)) {}

  const std::string& name() const override { return facts_.name; }
  void Append(std::string bytes) override {
    if (!Enter(Phase::kReceiving, Phase::kDecoding)) return;
    threads_.decoders.Post(facts_.origin, [self = shared_from_this(), bytes = std::move(bytes)] {
      self->Decode(bytes);
    });
  }
  void FinishVolume(std::optional<Sha256Digest> expected) override {
    if (!Enter(Phase::kReceiving, Phase::kDecoding)) return;
    threads_.finishers.Post(facts_.origin,
                            [self = shared_from_this(), expected] { self->DecodeRest(expected); });
  }
  void EndWith(absl::Status why) override {
    {
      std::lock_guard lock(mutex_);
      if (why_.ok()) why_ = std::move(why);
    }
    stop_.request_stop();
    {
      std::lock_guard lock(mutex_);
      const bool removed = phase_ == Phase::kWaiting && threads_.compute.Remove(entry_);
      if (phase_ != Phase::kReceiving && phase_ != Phase::kPaused && !removed) return;
      phase_ = Phase::kDecoding;
    }
    threads_.decoders.Post(facts_.origin, [self = shared_from_this()] {
      self->End(self->StopContext().StopStatus());
    });
  }

 private:
  enum class Phase { kReceiving, kDecoding, kPaused, kWaiting, kRunning, kEnded };

  // False if the job has been cancelled and the caller has nothing to do.
  bool Enter(Phase from, Phase to) {
    std::lock_guard lock(mutex_);
    if (phase_ != from) return false;
    phase_ = to;
    return true;
  }
  void Decode(const std::string& bytes) {
    absl::Status status =
        OnDecoderClock([&](const exec::Context& context) { return work_->Append(bytes, context); });
    std::shared_ptr<UploadListener> listener;
    if (status.ok()) {
      // A concurrent EndWith() sees either kDecoding, so that this check sees the stop, or
      // kReceiving.
      std::lock_guard lock(mutex_);
      status = StopContext().StopStatus();
      if (status.ok()) phase_ = Phase::kReceiving;
      listener = listener_;
    }
    if (!status.ok()) return End(std::move(status));
    listener->OnBytesConsumed();
  }
  void DecodeRest(const std::optional<Sha256Digest>& expected) {
    absl::Status status = OnDecoderClock(
        [&](const exec::Context& context) { return work_->Finish(expected, context); });
    if (status.ok()) status = memory_->SetBase(work_->BytesToRun());
    if (!status.ok()) return End(std::move(status));
    WaitForTurn();
  }
  // Runs and times a step of the decoder. Errors: the step's; those of a requested stop.
  template <typename Step>
  absl::Status OnDecoderClock(Step step) {
    const Clock::time_point start = Clock::now();
    const exec::Context context = StopContext();
    absl::Status status = context.StopStatus();
    if (status.ok()) status = OrOutOfMemory([&]() -> absl::Status { return step(context); });
    times_.decoded += Clock::now() - start;
    return status.ok() ? context.StopStatus() : status;
  }
  void WaitForTurn() {
    absl::Status stop;
    {
      std::lock_guard lock(mutex_);
      stop = StopContext().StopStatus();
      if (stop.ok()) {
        phase_ = Phase::kPaused;
        PostIfReady();
      }
    }
    if (!stop.ok()) End(std::move(stop));
  }
  void Wake() {
    std::lock_guard lock(mutex_);
    if (phase_ == Phase::kPaused) PostIfReady();
  }
  // Needs: mutex_ held.
  void PostIfReady() {
    if (!work_->MayRun()) return;
    phase_ = Phase::kWaiting;
    waiting_since_ = Clock::now();
    const ComputeQueue::Claim claim = {
        .origin = facts_.origin,
        .most_threads = work_->MostThreads(threads_.compute.threads()),
        .bricks = work_->Bricks()};
    entry_ = threads_.compute.Post(
        claim, [self = shared_from_this()](ComputeQueue::Turn& turn) { self->Run(turn); });
  }
  void Run(ComputeQueue::Turn& at_work) {
    const Clock::time_point start = Clock::now();
    {
      std::lock_guard lock(mutex_);
      phase_ = Phase::kRunning;
      times_.queued += start - waiting_since_;
    }
    absl::StatusOr<JobWork::Turn> turn =
        OrOutOfMemory([&]() -> absl::StatusOr<JobWork::Turn> { return RunTurn(at_work); });
    times_.computed += Clock::now() - start;
    if (!turn.ok() || *turn == JobWork::Turn::kDone) return End(std::move(turn).status());
    absl::Status base = memory_->SetBase(work_->BytesToRun());  // never more than before
    if (!base.ok()) return End(std::move(base));
    WaitForTurn();
  }
  absl::StatusOr<JobWork::Turn> RunTurn(ComputeQueue::Turn& turn) {
    exec::Context context = StopContext();
    context.team = &turn.team();
    context.share = [&turn] { return turn.share(); };
    context.yield = [&turn] { turn.Yield(); };
    return work_->Run(std::move(context), memory_, [job = weak_from_this()] {
      if (const auto self = job.lock()) self->Wake();
    });
  }
  void End(absl::Status status) {
    {
      std::lock_guard lock(mutex_);
      phase_ = Phase::kEnded;
      listener_ = nullptr;  // it holds the job
      // The last stage may have missed the stop; stages that saw it do not know its reason.
      if (stop_.stop_requested() && (status.ok() || absl::IsCancelled(status))) status = why_;
    }
    facts_.observer.on_end({.tenant = facts_.origin.tenant,
                            .status = status,
                            .times = times_,
                            .object_points = work_->ObjectPoints()});
    work_->End(std::move(status), times_, memory_->Close());
  }
  exec::Context StopContext() const {
    return {.stop = stop_.get_token(), .deadline = facts_.deadline, .on_shell = nullptr};
  }

  const PoolJobFacts facts_;
  const PoolJobThreads threads_;
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

}  // namespace

std::shared_ptr<Job> MakePoolJob(PoolJobFacts facts, std::unique_ptr<JobWork> work, Ticket ticket,
                                 std::shared_ptr<UploadListener> listener,
                                 const PoolJobThreads& threads) {
  return std::make_shared<PoolJob>(std::move(facts), std::move(work), std::move(ticket),
                                   std::move(listener), threads);
}

}  // namespace bccskel::server
