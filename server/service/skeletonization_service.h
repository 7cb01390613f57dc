#ifndef BCCSKEL_SERVER_SERVICE_SKELETONIZATION_SERVICE_H_
#define BCCSKEL_SERVER_SERVICE_SKELETONIZATION_SERVICE_H_

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/jobs/job_runner.h"

namespace bccskel::server {

class SkeletonizationService final : public v1::SkeletonizationService::CallbackService {
 public:
  // Needs: `runner` outlives the service's calls.
  SkeletonizationService(JobRunner& runner, const VolumeLimits& limits)
      : runner_(runner), limits_(limits) {}

  grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>* Skeletonize(
      grpc::CallbackServerContext* context) override;
  grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
  SkeletonizeLabels(grpc::CallbackServerContext* context) override;

 private:
  JobRunner& runner_;
  const VolumeLimits limits_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_SKELETONIZATION_SERVICE_H_
