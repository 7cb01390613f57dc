#ifndef BCCSKEL_SERVER_JOBS_JOB_WORK_H_
#define BCCSKEL_SERVER_JOBS_JOB_WORK_H_

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/digest/sha256.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "server/admission/admission.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {

// The part of a PoolJob that depends on its kind: what it receives and computes. The job itself
// handles threads, turns, cancellation and memory.
// Threads: the job calls one member at a time; MayRun() also between the other calls.
class JobWork {
 public:
  virtual ~JobWork() = default;

  // The next bytes of the volume.
  // Errors: INVALID_ARGUMENT, RESOURCE_EXHAUSTED, CANCELLED, DEADLINE_EXCEEDED.
  virtual absl::Status Append(std::string_view bytes, const exec::Context& context) = 0;
  // Called after the last Append(). Errors: as Append().
  virtual absl::Status Finish(const std::optional<Sha256Digest>& expected,
                              const exec::Context& context) = 0;

  // After Finish(): the memory that the rest of the work needs, and how many of `threads` it can
  // use.
  virtual uint64_t BytesToRun() const = 0;
  virtual int MostThreads(int threads) const = 0;
  virtual uint64_t Bricks() const = 0;  // the job's size, of the next turn or later ones

  // Whether the next turn may begin. If not, `wake` is called when that may have changed.
  virtual bool MayRun() const { return true; }
  enum class Turn { kDone, kMore };
  // One turn of computing, on the context's threads. Other jobs may run between turns.
  // Needs: MayRun(). `wake` may be called from any thread at any time, even after the end. Memory
  // taken from `memory` beyond BytesToRun() may be kept until End().
  // Errors: the core's; the budget's.
  virtual absl::StatusOr<Turn> Run(exec::Context context,
                                   const std::shared_ptr<exec::MemoryBudget>& memory,
                                   const std::function<void()>& wake) = 0;

  // Points of the computed objects. Called before End().
  virtual uint64_t ObjectPoints() const = 0;
  // Called once, last: releases the memory that is no longer needed and calls the listener.
  virtual void End(absl::Status status, const JobTimes& times, Ticket ticket) = 0;
};

// Computes the skeleton of one volume in one turn.
std::unique_ptr<JobWork> MakeSkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                                             VolumeReceiver::MakeDecoder make_decoder,
                                             std::shared_ptr<JobListener> listener);
// Computes a skeleton for each label of a volume. `threads` is the most that it may get; memory is
// reserved for that many.
std::unique_ptr<JobWork> MakeLabelsWork(LabelsRequest request, const VolumeLimits& limits,
                                        int threads, std::shared_ptr<LabelsListener> listener);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_WORK_H_
