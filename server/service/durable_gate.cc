#include "server/service/durable_gate.h"

#include "core/exec/status_macros.h"
#include "proto/wire/error_details.h"

namespace bccskel::server {

absl::StatusOr<DurableCall> DurableGate::Enter(const grpc::CallbackServerContext& context) const {
  BCCSKEL_ASSIGN_OR_RETURN(CallFacts facts, gate_.Enter(context));
  if (ledger_ != nullptr) return DurableCall{std::move(facts), *ledger_};
  return wire::WithReason(
      absl::FailedPreconditionError("this server keeps nothing on disk: it was started without "
                                    "--data-dir, so there are neither uploads nor durable jobs"),
      "NOT_DURABLE");
}

}  // namespace bccskel::server
