#include "server/calls/durable_gate.h"

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

// More than any name has.
constexpr size_t kMaxNameBytes = 128;

absl::Status CheckName(const DurableGate::Name& name) {
  if (name.name.empty()) return InvalidField(name.field, "must be set");
  if (name.name.size() <= kMaxNameBytes) return absl::OkStatus();
  return InvalidField(name.field,
                            absl::StrCat(name.name.size(), " bytes, the limit is ", kMaxNameBytes));
}

}  // namespace

absl::StatusOr<DurableCall> DurableGate::Enter(const grpc::CallbackServerContext& context,
                                               const Method& method) const {
  BCCSKEL_ASSIGN_OR_RETURN(CallFacts facts, gate_.Enter(context, method));
  if (ledger_ != nullptr) return DurableCall{std::move(facts), *ledger_};
  return Refused(facts,
                 CallError(Reason::kNotDurable, "this server keeps nothing on disk: it was started without "
                                      "--data-dir, so there are neither uploads nor durable jobs"));
}

absl::StatusOr<DurableCall> DurableGate::Enter(const grpc::CallbackServerContext& context,
                                               const Method& method, const Name& name) const {
  BCCSKEL_ASSIGN_OR_RETURN(DurableCall call, Enter(context, method));
  const absl::Status checked = CheckName(name);
  if (!checked.ok()) return Refused(call.facts, checked);
  return call;
}

}  // namespace bccskel::server
