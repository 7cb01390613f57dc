#ifndef BCCSKEL_SERVER_CALLS_WATCH_STREAM_H_
#define BCCSKEL_SERVER_CALLS_WATCH_STREAM_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "bccskel/v1/job_service.pb.h"
#include "server/calls/durable_gate.h"

namespace bccskel::server {

// Starts the handler of a WatchJob call. Needs: the ledger outlives the call.
grpc::ServerWriteReactor<v1::WatchJobResponse>* StartWatchStream(
    absl::StatusOr<DurableCall> call, const v1::WatchJobRequest& request);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_WATCH_STREAM_H_
