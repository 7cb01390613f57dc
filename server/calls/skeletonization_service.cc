#include <memory>
#include <utility>

#include "server/calls/durable_session.h"
#include "server/calls/memory_session.h"
#include "server/calls/services.h"

namespace bccskel::server {
namespace {

constexpr Method kSkeletonize{"SkeletonizationService/Skeletonize"};
constexpr Method kSkeletonizeLabels{"SkeletonizationService/SkeletonizeLabels"};

}  // namespace

grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>*
SkeletonizationService::Skeletonize(grpc::CallbackServerContext* context) {
  using Call = SessionCall<v1::SkeletonizeRequest, v1::SkeletonizeResponse>;
  return StartCall<Call>(
      gate_.Enter(*context, kSkeletonize),
      [this](const Call::Config& config,
             std::shared_ptr<SessionOwner> owner) -> std::shared_ptr<Call::Work> {
        if (durable_jobs_ != nullptr && DurableSession::Suits(config, limits_)) {
          return std::make_shared<DurableSession>(std::move(owner), *durable_jobs_, writers_);
        }
        return std::make_shared<SkeletonSession>(std::move(owner), runner_, limits_);
      });
}

grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
SkeletonizationService::SkeletonizeLabels(grpc::CallbackServerContext* context) {
  using Call = SessionCall<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>;
  return StartCall<Call>(
      gate_.Enter(*context, kSkeletonizeLabels),
      [this](const Call::Config&,
             std::shared_ptr<SessionOwner> owner) -> std::shared_ptr<Call::Work> {
        return std::make_shared<LabelsSession>(std::move(owner), runner_, limits_);
      });
}

}  // namespace bccskel::server
