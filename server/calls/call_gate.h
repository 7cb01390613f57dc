#ifndef BCCSKEL_SERVER_CALLS_CALL_GATE_H_
#define BCCSKEL_SERVER_CALLS_CALL_GATE_H_

#include <grpcpp/grpcpp.h>

#include <atomic>
#include <chrono>

#include "absl/status/statusor.h"
#include "server/identity/callers.h"
#include "server/calls/call_facts.h"
#include "server/calls/lasting_calls.h"

namespace bccskel::server {

// Where every call of every service comes in: whose is it? A handler learns the tenant here and
// nowhere else. Calls that are refused are logged here.
// Threads: safe.
class CallGate {
 public:
  // Callers who send nothing for `sender_timeout` are sent away; 0: never. Needs: `callers`
  // outlives the gate.
  explicit CallGate(const Callers& callers, std::chrono::milliseconds sender_timeout = {})
      : callers_(callers), lasting_(callers, sender_timeout) {}

  // Errors: UNAUTHENTICATED for a missing or wrong token.
  absl::StatusOr<CallFacts> Enter(const grpc::CallbackServerContext& context,
                                  const Method& method) const;
  // Errors besides: PERMISSION_DENIED for who is no admin.
  absl::StatusOr<CallFacts> EnterAsAdmin(const grpc::CallbackServerContext& context,
                                         const Method& method) const;

  // From now on calls that gRPC cancels are the server's doing.
  void CutOff() { cut_off_ = true; }
  // Called once a second.
  void LookAfterCalls() { lasting_.LookAfter(); }

 private:
  const Callers& callers_;
  mutable LastingCalls lasting_;
  std::atomic<bool> cut_off_ = false;
};

// The error of a call that goes no further, which is logged.
absl::Status Refused(const CallFacts& facts, const absl::Status& status);

// Ends a unary call: with OK, or with the error and its details.
grpc::ServerUnaryReactor* EndUnary(grpc::CallbackServerContext& context,
                                   const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_CALL_GATE_H_
