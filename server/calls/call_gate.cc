#include "server/calls/call_gate.h"

#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "core/exec/status_macros.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

std::optional<std::string_view> AuthorizationOf(const grpc::CallbackServerContext& context) {
  const auto header = context.client_metadata().find("authorization");
  if (header == context.client_metadata().end()) return std::nullopt;
  return std::string_view(header->second.data(), header->second.size());
}

}  // namespace

absl::StatusOr<CallFacts> CallGate::Enter(const grpc::CallbackServerContext& context,
                                          const Method& method) const {
  CallFacts facts = FactsOf(context);
  facts.method = method;
  facts.cut_off = &cut_off_;
  facts.lasting = &lasting_;
  facts.tokens = callers_.generation();  // first: a file that is read meanwhile is looked at again
  const auto authorization = AuthorizationOf(context);
  facts.authorization = authorization.value_or(std::string_view());
  absl::StatusOr<Caller> caller = callers_.Identify(authorization);
  if (!caller.ok()) {
    facts.tenant.clear();
    const Reason reason =
        authorization.has_value() ? Reason::kTokenInvalid : Reason::kTokenMissing;
    return Refused(facts, CallError(reason, std::string(caller.status().message())));
  }
  facts.tenant = std::move(caller->tenant);
  facts.role = caller->role;
  return facts;
}

absl::StatusOr<CallFacts> CallGate::EnterAsAdmin(const grpc::CallbackServerContext& context,
                                                 const Method& method) const {
  BCCSKEL_ASSIGN_OR_RETURN(CallFacts facts, Enter(context, method));
  if (facts.role == Role::kAdmin) return facts;
  return Refused(facts, CallError(Reason::kAdminOnly, "this call is for admins; the token is a tenant's"));
}

absl::Status Refused(const CallFacts& facts, const absl::Status& status) {
  facts.LogEnded(std::string(), status);
  return status;
}

grpc::ServerUnaryReactor* EndUnary(grpc::CallbackServerContext& context,
                                   const absl::Status& status) {
  grpc::ServerUnaryReactor* reactor = context.DefaultReactor();
  reactor->Finish(ToGrpcStatus(status));
  return reactor;
}

}  // namespace bccskel::server
