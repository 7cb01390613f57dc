#ifndef BCCSKEL_SERVER_CALLS_RESULT_STREAM_H_
#define BCCSKEL_SERVER_CALLS_RESULT_STREAM_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "server/calls/durable_gate.h"

namespace bccskel::server {

// Starts the handler of a ReadSkeleton call. Needs: the ledger outlives the call.
grpc::ServerWriteReactor<v1::ReadSkeletonResponse>* StartResultStream(
    absl::StatusOr<DurableCall> call, const v1::ReadSkeletonRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_RESULT_STREAM_H_
