#ifndef BCCSKEL_CLIENT_GRPC_ATTEMPT_H_
#define BCCSKEL_CLIENT_GRPC_ATTEMPT_H_

#include <grpcpp/grpcpp.h>

#include <chrono>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "client/channel.h"

namespace bccskel::client {

// Makes one attempt at a call on `channel`; `stop` cancels it.
// Errors: CANCELLED if the stop was requested before; those of `call`.
template <typename Call>
auto Attempt(grpc::Channel& channel, const std::stop_token& stop,
             std::chrono::system_clock::time_point deadline, Call call)
    -> decltype(call(std::declval<grpc::ClientContext&>())) {
  if (stop.stop_requested()) return absl::CancelledError("cancelled by the caller");
  AwaitReconnection(channel, deadline);
  grpc::ClientContext context;
  context.set_deadline(deadline);
  const std::stop_callback cancel(stop, [&context] { context.TryCancel(); });
  return call(context);
}

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_GRPC_ATTEMPT_H_
