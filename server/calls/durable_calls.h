#ifndef BCCSKEL_SERVER_CALLS_DURABLE_CALLS_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_CALLS_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "bccskel/v1/volume_service.pb.h"
#include "server/calls/call_gate.h"
#include "server/calls/upload_writers.h"
#include "server/jobs/job_pool.h"

namespace bccskel::server {

// Handlers of the streams about what outlives the process. Each of them starts one.
// Needs: the call's DurableJobs, and `writers`, outlive the call; gRPC keeps `response` for its
// length.
grpc::ServerReadReactor<v1::UploadVolumeRequest>* StartUpload(absl::StatusOr<DurableCall> call,
                                                              UploadWriters& writers,
                                                              const JobPool::Limits& limits,
                                                              v1::UploadVolumeResponse& response);
grpc::ServerWriteReactor<v1::WatchJobResponse>* StartWatch(absl::StatusOr<DurableCall> call,
                                                           const v1::WatchJobRequest& request);
grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* StartRead(
    absl::StatusOr<DurableCall> call, const v1::ReadSkeletonRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_CALLS_H_
