#ifndef BCCSKEL_SERVER_JOBS_POOL_JOB_H_
#define BCCSKEL_SERVER_JOBS_POOL_JOB_H_

#include <memory>
#include <string>

#include "server/jobs/compute_queue.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/job_work.h"
#include "server/jobs/task_threads.h"

namespace bccskel::server {

// The threads that jobs run on.
struct PoolJobThreads {
  TaskThreads& decoders;
  TaskThreads& finishers;  // for the end of decoding, which may wait for a child
  ComputeQueue& compute;
};
struct PoolJobFacts {
  std::string name;
  JobOrigin origin;
  exec::Context::Clock::time_point deadline;
  uint64_t min_bytes;  // as in JobWish
  const JobObserver& observer;
};

// A job of a JobPool: receives its volume in pieces, decodes each on a decoder thread, then waits
// for its turn and computes, in as many turns as its work needs.
// Needs: the threads and the observer outlive the job.
std::shared_ptr<Job> MakePoolJob(PoolJobFacts facts, std::unique_ptr<JobWork> work, Ticket ticket,
                                 std::shared_ptr<UploadListener> listener,
                                 const PoolJobThreads& threads);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_POOL_JOB_H_
