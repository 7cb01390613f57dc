#ifndef BCCSKEL_SERVER_METRICS_METERED_RUNNER_H_
#define BCCSKEL_SERVER_METRICS_METERED_RUNNER_H_

#include <memory>

#include "server/jobs/job_runner.h"
#include "server/metrics/server_metrics.h"

namespace bccskel::server {

// Counts the jobs of another runner.
class MeteredRunner final : public JobRunner {
 public:
  // Needs: both outlive the runner and its jobs.
  MeteredRunner(JobRunner& runner, ServerMetrics& metrics) : runner_(runner), metrics_(metrics) {}

  absl::StatusOr<std::shared_ptr<Job>> Start(JobRequest request,
                                             std::shared_ptr<JobListener> listener) override;
  absl::StatusOr<std::shared_ptr<Job>> Start(LabelsRequest request,
                                             std::shared_ptr<LabelsListener> listener) override;

 private:
  template <typename Metered, typename Request, typename Listener>
  absl::StatusOr<std::shared_ptr<Job>> StartMetered(Request request,
                                                    std::shared_ptr<Listener> listener);

  JobRunner& runner_;
  ServerMetrics& metrics_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_METERED_RUNNER_H_
