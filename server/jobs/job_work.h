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

// What a job receives and computes: the part of a PoolJob that depends on its kind. The job
// knows threads, turns, cancellation and memory.
// Threads: the job calls one member at a time; MayRun() also while nothing else is under way.
class JobWork {
 public:
  virtual ~JobWork() = default;

  // The next bytes of the volume.
  // Errors: INVALID_ARGUMENT, RESOURCE_EXHAUSTED, CANCELLED, DEADLINE_EXCEEDED.
  virtual absl::Status Append(std::string_view bytes, const exec::Context& context) = 0;
  // All bytes were appended. Errors: as Append().
  virtual absl::Status Finish(const std::optional<Sha256Digest>& expected,
                              const exec::Context& context) = 0;

  // After Finish(): memory that the rest takes, and threads of `threads` that it can use.
  virtual uint64_t BytesToRun() const = 0;
  virtual int MostThreads(int threads) const = 0;
  virtual uint64_t Bricks() const = 0;  // its size, of the next turn or more

  // Whether the next turn may begin. Where not, `wake` is called when that may have changed.
  virtual bool MayRun() const { return true; }
  enum class Turn { kDone, kMore };
  // One turn at computing, on the context's threads. Between turns other jobs have theirs.
  // Needs: MayRun(). `wake` may be called from any thread at any time, even after the end. What is
  // taken of `memory` beside BytesToRun() may be kept until End().
  // Errors: as the core's; the budget's.
  virtual absl::StatusOr<Turn> Run(exec::Context context,
                                   const std::shared_ptr<exec::MemoryBudget>& memory,
                                   const std::function<void()>& wake) = 0;

  // Points of the object that was computed, or of all of them. Called before End().
  virtual uint64_t ObjectPoints() const = 0;
  // Called once, last: gives back the memory that is no longer needed and tells the listener.
  virtual void End(absl::Status status, const JobTimes& times, Ticket ticket) = 0;
};

// One volume, one skeleton, in one turn.
std::unique_ptr<JobWork> MakeSkeletonizeWork(JobRequest request, const VolumeLimits& limits,
                                             VolumeReceiver::MakeDecoder make_decoder,
                                             std::shared_ptr<JobListener> listener);
// A volume of labels, a skeleton for each. `threads` that it may get at most; memory is reserved
// for so many.
std::unique_ptr<JobWork> MakeLabelsWork(LabelsRequest request, const VolumeLimits& limits,
                                        int threads, std::shared_ptr<LabelsListener> listener);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_WORK_H_
