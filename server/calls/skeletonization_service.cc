#include "server/calls/skeletonization_service.h"

#include <utility>

#include "server/calls/choosing_stream.h"
#include "server/calls/labels_stream.h"
#include "server/calls/skeletonize_stream.h"

namespace bccskel::server {
namespace {

constexpr Method kSkeletonize{"SkeletonizationService/Skeletonize"};
constexpr Method kSkeletonizeLabels{"SkeletonizationService/SkeletonizeLabels"};

}  // namespace

grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>*
SkeletonizationService::Skeletonize(grpc::CallbackServerContext* context) {
  absl::StatusOr<CallFacts> facts = gate_.Enter(*context, kSkeletonize);
  if (ledger_ == nullptr) {
    return StartStream<SkeletonizeStream>(std::move(facts), runner_, limits_);
  }
  return StartStream<ChoosingStream>(std::move(facts), runner_, limits_, *ledger_, writers_);
}

grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
SkeletonizationService::SkeletonizeLabels(grpc::CallbackServerContext* context) {
  return StartStream<LabelsStream>(gate_.Enter(*context, kSkeletonizeLabels), runner_, limits_);
}

}  // namespace bccskel::server
