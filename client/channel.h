#ifndef BCCSKEL_CLIENT_CHANNEL_H_
#define BCCSKEL_CLIENT_CHANNEL_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <memory>

#include "absl/status/statusor.h"
#include "client/endpoint.h"

namespace bccskel::client {

// The only place where the client makes gRPC channels: TLS, the token with every call, pings, and
// how to reconnect. Nothing is sent yet.
// Errors: as CheckEndpoint().
absl::StatusOr<std::shared_ptr<grpc::Channel>> OpenChannel(const Endpoint& endpoint);

// If the channel is reconnecting, waits for it, for 300 ms and until the deadline at most. gRPC
// reconnects by itself after a failure, but reads the server's first frame only while a caller
// waits for the channel; without this wait, calls after a pause found that the connection had timed
// out.
void AwaitReconnection(grpc::Channel& channel, std::chrono::system_clock::time_point deadline);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_CHANNEL_H_
