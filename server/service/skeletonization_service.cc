#include "server/service/skeletonization_service.h"

#include "server/service/choosing_stream.h"
#include "server/service/labels_stream.h"
#include "server/service/skeletonize_stream.h"

namespace bccskel::server {

grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>*
SkeletonizationService::Skeletonize(grpc::CallbackServerContext* context) {
  if (ledger_ == nullptr) return StartStream<SkeletonizeStream>(*context, gate_, runner_, limits_);
  return StartStream<ChoosingStream>(*context, gate_, runner_, limits_, *ledger_, writers_);
}

grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
SkeletonizationService::SkeletonizeLabels(grpc::CallbackServerContext* context) {
  return StartStream<LabelsStream>(*context, gate_, runner_, limits_);
}

}  // namespace bccskel::server
