#ifndef BCCSKEL_CLIENT_GRPC_ATTEMPT_H_
#define BCCSKEL_CLIENT_GRPC_ATTEMPT_H_

#include <grpcpp/grpcpp.h>

#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "client/channel.h"
#include "client/grpc_status.h"
#include "client/retry_loop.h"

namespace bccskel::client {

// Makes one attempt at a call on `channel`.
// Errors: CANCELLED only if the stop was requested or the server says so in its details; those of
//         `call`.
template <typename Call>
auto Attempt(grpc::Channel& channel, const RetryLoop::Limits& limits, Call call)
    -> decltype(call(std::declval<grpc::ClientContext&>())) {
  if (limits.stop.stop_requested()) return absl::CancelledError("cancelled by the caller");
  AwaitReconnection(channel, limits.deadline);
  grpc::ClientContext context;
  context.set_deadline(limits.deadline);
  const std::stop_callback cancel(limits.stop, [&context] { context.TryCancel(); });
  return WithoutForeignCancel(call(context), limits.stop);
}

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_GRPC_ATTEMPT_H_
