#include "server/service/call_gate.h"

#include "server/status_mapping.h"

namespace bccskel::server {

absl::StatusOr<CallFacts> CallGate::Enter(const grpc::CallbackServerContext& context) const {
  return FactsOf(context);
}

grpc::ServerUnaryReactor* EndUnary(grpc::CallbackServerContext& context,
                                   const absl::Status& status) {
  grpc::ServerUnaryReactor* reactor = context.DefaultReactor();
  reactor->Finish(ToGrpcStatus(status));
  return reactor;
}

}  // namespace bccskel::server
