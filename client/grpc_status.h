#ifndef BCCSKEL_CLIENT_GRPC_STATUS_H_
#define BCCSKEL_CLIENT_GRPC_STATUS_H_

#include <grpcpp/support/status.h>

#include <stop_token>

#include "absl/status/status.h"
#include "absl/status/statusor.h"

namespace bccskel::client {

// The only place in the client that reads a grpc::Status. The details in its trailer become
// payloads of the absl::Status.
absl::Status FromGrpcStatus(const grpc::Status& status);

// gRPC cancels calls that reach a stopping server: reports CANCELLED that nobody here requested as
// UNAVAILABLE.
absl::Status WithoutForeignCancel(const absl::Status& error, const std::stop_token& stop);
template <typename Value>
absl::StatusOr<Value> WithoutForeignCancel(absl::StatusOr<Value> value,
                                           const std::stop_token& stop) {
  if (value.ok()) return value;
  return WithoutForeignCancel(value.status(), stop);
}

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_GRPC_STATUS_H_
