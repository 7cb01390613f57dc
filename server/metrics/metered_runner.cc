#include "server/metrics/metered_runner.h"

#include <string>
#include <utility>

#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"
#include "server/metrics/call_meter.h"

namespace bccskel::server {
namespace {

EndedJob Ended(const std::string& tenant, const absl::Status& status) {
  const grpc::Status seen = ToGrpcStatus(WithJobReason(status));
  EndedJob ended;
  ended.tenant = tenant;
  ended.code = CodeName(seen);
  ended.reason = ReasonNameOf(seen);
  return ended;
}

// Passes on what it hears, and counts the end.
class MeteredJob final : public JobListener {
 public:
  MeteredJob(std::shared_ptr<JobListener> listener, std::string tenant, ServerMetrics& metrics)
      : listener_(std::move(listener)), tenant_(std::move(tenant)), metrics_(metrics) {}

  void OnBytesConsumed() override { listener_->OnBytesConsumed(); }
  void OnVolume(const Volume& volume) override { listener_->OnVolume(volume); }
  void OnShell(const exec::ShellProgress& progress, std::chrono::nanoseconds elapsed) override {
    listener_->OnShell(progress, elapsed);
  }
  uint64_t OnShellPoints(int32_t shell, const Volume& points) override {
    return listener_->OnShellPoints(shell, points);
  }
  void OnEnd(absl::StatusOr<JobResult> result) override {
    EndedJob ended = Ended(tenant_, result.status());
    if (result.ok()) {
      ended.queued = result->queued;
      ended.decoded = result->decoded;
      ended.computed = result->skeleton.timings.total;
      ended.object_points = result->skeleton.object_points;
    }
    metrics_.Count(ended);  // first: who hears of the end may look at the figures
    listener_->OnEnd(std::move(result));
  }

 private:
  const std::shared_ptr<JobListener> listener_;
  const std::string tenant_;
  ServerMetrics& metrics_;
};

class MeteredLabels final : public LabelsListener {
 public:
  MeteredLabels(std::shared_ptr<LabelsListener> listener, std::string tenant,
                ServerMetrics& metrics)
      : listener_(std::move(listener)), tenant_(std::move(tenant)), metrics_(metrics) {}

  void OnBytesConsumed() override { listener_->OnBytesConsumed(); }
  void OnProgress(uint64_t done, uint64_t total, std::chrono::nanoseconds elapsed) override {
    listener_->OnProgress(done, total, elapsed);
  }
  void OnLabel(LabelResult result) override { listener_->OnLabel(std::move(result)); }
  void OnEnd(absl::StatusOr<LabelsResult> result) override {
    EndedJob ended = Ended(tenant_, result.status());
    if (result.ok()) {
      ended.queued = result->times.queued;
      ended.decoded = result->times.decoded;
      ended.computed = result->times.computed;
      ended.object_points = result->object_points;
    }
    metrics_.Count(ended);
    listener_->OnEnd(std::move(result));
  }

 private:
  const std::shared_ptr<LabelsListener> listener_;
  const std::string tenant_;
  ServerMetrics& metrics_;
};

}  // namespace

template <typename Metered, typename Request, typename Listener>
absl::StatusOr<std::shared_ptr<Job>> MeteredRunner::StartMetered(
    Request request, std::shared_ptr<Listener> listener) {
  const uint64_t volume_bytes = request.size_bytes;
  const auto metered =
      std::make_shared<Metered>(std::move(listener), request.origin.tenant, metrics_);
  absl::StatusOr<std::shared_ptr<Job>> job = runner_.Start(std::move(request), metered);
  if (job.ok()) metrics_.CountAdmitted(volume_bytes);
  return job;
}

absl::StatusOr<std::shared_ptr<Job>> MeteredRunner::Start(JobRequest request,
                                                          std::shared_ptr<JobListener> listener) {
  return StartMetered<MeteredJob>(std::move(request), std::move(listener));
}

absl::StatusOr<std::shared_ptr<Job>> MeteredRunner::Start(
    LabelsRequest request, std::shared_ptr<LabelsListener> listener) {
  return StartMetered<MeteredLabels>(std::move(request), std::move(listener));
}

}  // namespace bccskel::server
