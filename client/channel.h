#ifndef BCCSKEL_CLIENT_CHANNEL_H_
#define BCCSKEL_CLIENT_CHANNEL_H_

#include <grpcpp/grpcpp.h>

#include <memory>

#include "absl/status/statusor.h"
#include "client/endpoint.h"

namespace bccskel::client {

// The only place where the client makes gRPC channels: TLS, the token with every call, pings, and
// how to reconnect. Nothing is sent yet.
// Errors: as CheckEndpoint().
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const Endpoint& endpoint);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_CHANNEL_H_
