#ifndef BCCSKEL_SERVER_CALLS_UPLOAD_STREAM_H_
#define BCCSKEL_SERVER_CALLS_UPLOAD_STREAM_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "bccskel/v1/volume_service.pb.h"
#include "server/jobs/job_pool.h"
#include "server/calls/durable_gate.h"
#include "server/calls/upload_writers.h"

namespace bccskel::server {

// Starts the handler of an UploadVolume call.
// Needs: `writers` and the ledger outlive the call; gRPC keeps `response` for its length.
grpc::ServerReadReactor<v1::UploadVolumeRequest>* StartUploadStream(
    absl::StatusOr<DurableCall> call, UploadWriters& writers, const JobPool::Limits& limits,
    v1::UploadVolumeResponse& response);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UPLOAD_STREAM_H_
