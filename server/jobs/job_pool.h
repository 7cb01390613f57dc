#ifndef BCCSKEL_SERVER_JOBS_JOB_POOL_H_
#define BCCSKEL_SERVER_JOBS_JOB_POOL_H_

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "server/admission/admission.h"
#include "server/decoding/child_pool.h"
#include "server/jobs/compute_queue.h"
#include "server/jobs/job_runner.h"
#include "server/jobs/task_threads.h"
#include "server/jobs/volume_receiver.h"

namespace bccskel::server {

// Runs jobs in this process: admits them, decodes on its own threads and computes on those of a
// ComputeQueue. Jobs end with the process.
class JobPool : public JobRunner {
 public:
  struct Limits {
    int threads = 1;                // for computing, all jobs together
    int max_jobs = 1;               // running at the same time
    int max_queue = 0;              // further jobs receiving or waiting
    uint64_t max_bytes = 0;         // working memory of all jobs together
    uint64_t max_volume_bytes = 0;  // encoded, of one job
    VolumeLimits volume;
    TenantTable tenants = {};
    // Of child processes that decode OpenEXR (decoding/child_pool.h), such as ThisProgramAsChild();
    // empty: this process decodes it.
    std::vector<std::string> child_command = {};

    // Errors: RESOURCE_EXHAUSTED for a volume over the limit.
    absl::Status CheckVolumeBytes(uint64_t size_bytes) const;
  };

  explicit JobPool(const Limits& limits, JobObserver observer = {});

  absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest request,
                                             std::shared_ptr<JobListener> listener) override;
  absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest request,
                                             std::shared_ptr<LabelsListener> listener) override;

  // Replaces the weights and caps in the limits.
  void SetTenants(const TenantTable& tenants);
  // Refuses new jobs; admitted ones continue.
  void StopAdmitting() { admission_.StopAdmitting(); }
  // Returns when no job and no result is left, or after `timeout`.
  void WaitUntilEmpty(std::chrono::milliseconds timeout) const {
    admission_.WaitUntilEmpty(timeout);
  }

  ComputeQueue::Usage compute_usage() const { return compute_.usage(); }
  Admission::Usage admission_usage() const { return admission_.usage(); }
  // Jobs that have not ended or whose results still hold memory.
  int admitted_jobs() const { return admission_.jobs(); }

 private:
  template <typename MakeWork>
  absl::StatusOr<std::shared_ptr<Job>> Launch(const JobWish& wish, uint64_t bytes,
                                              TaskThreads& finishers,
                                              std::shared_ptr<UploadListener> listener,
                                              MakeWork make_work);
  bool InChild(const VolumeHeader& header) const;
  VolumeReceiver::MakeDecoder DecoderFor(const JobRequest& request);

  const Limits limits_;
  const JobObserver observer_;
  Admission admission_;
  ComputeQueue compute_;
  std::unique_ptr<ChildPool> children_;  // null if nothing is decoded in children
  // Destroyed first: their tasks may still post to compute_.
  TaskThreads decoders_;
  TaskThreads finishers_;  // may wait for children; each job has at most one task
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_JOB_POOL_H_
