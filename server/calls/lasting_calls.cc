#include "server/calls/lasting_calls.h"

#include <utility>
#include <vector>

#include "server/calls/call_facts.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

void LastingCalls::Add(const std::shared_ptr<LastingCall>& call, const CallFacts& facts) {
  std::lock_guard lock(mutex_);
  calls_[call.get()] = {call, facts.authorization, facts.tenant, facts.tokens};
}

void LastingCalls::Remove(const LastingCall& call) {
  std::lock_guard lock(mutex_);
  calls_.erase(&call);
}

absl::Status LastingCalls::CheckToken(Entry& entry, uint64_t generation) const {
  if (std::exchange(entry.tokens, generation) == generation) return absl::OkStatus();
  const absl::StatusOr<Caller> caller = callers_.Identify(entry.authorization);
  if (caller.ok() && caller->tenant == entry.tenant) return absl::OkStatus();
  return CallError(Reason::kTokenInvalid, "the token of this call is accepted no longer");
}

void LastingCalls::LookAfter() {
  using Seen = std::pair<std::shared_ptr<LastingCall>, absl::Status>;
  const uint64_t generation = callers_.generation();
  std::vector<Seen> seen;
  {
    std::lock_guard lock(mutex_);
    for (auto& [pointer, entry] : calls_) {
      if (auto call = entry.call.lock()) {
        seen.emplace_back(std::move(call), CheckToken(entry, generation));
      }
    }
  }
  const auto now = std::chrono::steady_clock::now();
  for (auto& [call, status] : seen) {
    if (status.ok() && sender_timeout_.count() > 0) {
      status = call->CheckSender(now, sender_timeout_);
    }
    if (!status.ok()) call->EndEarly(status);
  }
}

}  // namespace bccskel::server
