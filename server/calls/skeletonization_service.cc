#include <memory>
#include <utility>

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/calls/durable_session.h"
#include "server/calls/memory_session.h"
#include "server/calls/services.h"

namespace bccskel::server {
namespace {

constexpr Method kSkeletonize{"SkeletonizationService/Skeletonize"};
constexpr Method kSkeletonizeLabels{"SkeletonizationService/SkeletonizeLabels"};

class SkeletonizationService final : public v1::SkeletonizationService::CallbackService {
 public:
  SkeletonizationService(const CallGate& gate, JobRunner& runner, const VolumeLimits& limits,
                         UploadWriters& writers)
      : gate_(gate), runner_(runner), limits_(limits), writers_(writers) {}

  grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>* Skeletonize(
      grpc::CallbackServerContext* context) override {
    using Call = SessionCall<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;
    return StartCall<Call>(gate_.Enter(*context, kSkeletonize),
                           [this](const Call::Config& config,
                                  std::shared_ptr<Call> call) -> std::shared_ptr<Call::Work> {
                             DurableJobs* const durable_jobs = gate_.durable_jobs();
                             if (durable_jobs != nullptr && IsDurable(config, limits_)) {
                               return MakeDurableSession(std::move(call), *durable_jobs, writers_);
                             }
                             return std::make_shared<SkeletonSession>(std::move(call), runner_,
                                                                      limits_);
                           });
  }

  grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
  SkeletonizeLabels(grpc::CallbackServerContext* context) override {
    using Call = SessionCall<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>;
    return StartCall<Call>(
        gate_.Enter(*context, kSkeletonizeLabels),
        [this](const Call::Config&, std::shared_ptr<Call> call) -> std::shared_ptr<Call::Work> {
          return std::make_shared<LabelsSession>(std::move(call), runner_, limits_);
        });
  }

 private:
  const CallGate& gate_;
  JobRunner& runner_;
  const VolumeLimits limits_;
  UploadWriters& writers_;
};

}  // namespace

std::unique_ptr<grpc::Service> MakeSkeletonizationService(const CallGate& gate, JobRunner& runner,
                                                          const VolumeLimits& limits,
                                                          UploadWriters& writers) {
  return std::make_unique<SkeletonizationService>(gate, runner, limits, writers);
}

}  // namespace bccskel::server
