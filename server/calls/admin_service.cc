#include <string>

#include "server/calls/services.h"
#include "server/calls/unary_answer.h"

namespace bccskel::server {
namespace {

constexpr Method kGetServerStatus{"AdminService/GetServerStatus", Method::Kind::kQuestion};

}  // namespace

grpc::ServerUnaryReactor* AdminService::GetServerStatus(grpc::CallbackServerContext* context,
                                                        const v1::GetServerStatusRequest*,
                                                        v1::GetServerStatusResponse* response) {
  const absl::StatusOr<CallFacts> facts = gate_.EnterAsAdmin(*context, kGetServerStatus);
  if (!facts.ok()) return EndUnary(*context, facts.status());
  *response = status_();
  return UnaryEnd(*context, *facts, std::string())(absl::OkStatus());
}

}  // namespace bccskel::server
