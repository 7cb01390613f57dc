#ifndef BCCSKEL_SERVER_CALLS_SKELETONIZATION_SERVICE_H_
#define BCCSKEL_SERVER_CALLS_SKELETONIZATION_SERVICE_H_

#include "bccskel/v1/skeletonization_service.grpc.pb.h"
#include "server/durable/ledger.h"
#include "server/jobs/job_runner.h"
#include "server/calls/call_gate.h"
#include "server/calls/upload_writers.h"

namespace bccskel::server {

class SkeletonizationService final : public v1::SkeletonizationService::CallbackService {
 public:
  // Needs: all outlive the service's calls. `ledger` is null where nothing is durable.
  SkeletonizationService(const CallGate& gate, JobRunner& runner, const VolumeLimits& limits,
                         Ledger* ledger, UploadWriters& writers)
      : gate_(gate), runner_(runner), limits_(limits), ledger_(ledger), writers_(writers) {}

  grpc::ServerBidiReactor<v1::SkeletonizeRequest, v1::SkeletonizeResponse>* Skeletonize(
      grpc::CallbackServerContext* context) override;
  grpc::ServerBidiReactor<v1::SkeletonizeLabelsRequest, v1::SkeletonizeLabelsResponse>*
  SkeletonizeLabels(grpc::CallbackServerContext* context) override;

 private:
  const CallGate& gate_;
  JobRunner& runner_;
  const VolumeLimits limits_;
  Ledger* const ledger_;
  UploadWriters& writers_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SKELETONIZATION_SERVICE_H_
