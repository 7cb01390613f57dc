#ifndef BCCSKEL_CLIENT_GRPC_STATUS_H_
#define BCCSKEL_CLIENT_GRPC_STATUS_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace bccskel::client {

// The only place in the client that reads a grpc::Status. The details in its trailer become
// payloads of the absl::Status.
absl::Status FromGrpcStatus(const grpc::Status& status);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_GRPC_STATUS_H_
