#ifndef BCCSKEL_SERVER_CALLS_DURABLE_GATE_H_
#define BCCSKEL_SERVER_CALLS_DURABLE_GATE_H_

#include <grpcpp/grpcpp.h>

#include <string>

#include "absl/status/statusor.h"
#include "server/durable/ledger.h"
#include "server/calls/call_gate.h"

namespace bccskel::server {

// A call to something that outlives the process.
struct DurableCall {
  CallFacts facts;
  Ledger& ledger;

  const std::string& tenant() const { return facts.tenant; }
};

// Where such calls come in.
// Threads: safe.
class DurableGate {
 public:
  // Needs: both outlive the gate. `ledger` is null where nothing is durable.
  DurableGate(const CallGate& gate, Ledger* ledger) : gate_(gate), ledger_(ledger) {}

  // Errors: those of CallGate::Enter(); FAILED_PRECONDITION without a ledger.
  absl::StatusOr<DurableCall> Enter(const grpc::CallbackServerContext& context,
                                    const Method& method) const;
  // For calls about something that has a name, as `field` of the request says.
  // Errors besides: INVALID_ARGUMENT for what can be nobody's name.
  struct Name {
    const char* field;
    const std::string& name;
  };
  absl::StatusOr<DurableCall> Enter(const grpc::CallbackServerContext& context,
                                    const Method& method, const Name& name) const;

 private:
  const CallGate& gate_;
  Ledger* const ledger_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_DURABLE_GATE_H_
