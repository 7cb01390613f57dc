#ifndef BCCSKEL_SERVER_SERVICE_DURABLE_GATE_H_
#define BCCSKEL_SERVER_SERVICE_DURABLE_GATE_H_

#include <grpcpp/grpcpp.h>

#include "absl/status/statusor.h"
#include "server/durable/ledger.h"
#include "server/service/call_gate.h"

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
  absl::StatusOr<DurableCall> Enter(const grpc::CallbackServerContext& context) const;

 private:
  const CallGate& gate_;
  Ledger* const ledger_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_DURABLE_GATE_H_
