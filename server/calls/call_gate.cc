#include "server/calls/call_gate.h"

#include <algorithm>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "absl/strings/str_cat.h"
#include "core/exec/status_macros.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"
#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

using Clock = CallFacts::Clock;

// gRPC states deadlines in wall-clock time; adjustments of the clock must not affect jobs.
Clock::time_point SteadyDeadline(std::chrono::system_clock::time_point deadline) {
  const auto left = deadline - std::chrono::system_clock::now();
  constexpr auto kFar = std::chrono::hours(24 * 365);
  return left > kFar ? Clock::time_point::max() : Clock::now() + left;
}

// W3C Trace Context: version, trace, parent and flags. Anything else stays out of the log, which
// must not hold arbitrary text of callers.
bool IsTraceparent(std::string_view text) {
  constexpr std::string_view kShape = "xx-xxxxxxxxxxxxxxxxxxxxxxxxxxxxxxxx-xxxxxxxxxxxxxxxx-xx";
  const auto fits = [](char c, char shape) {
    const bool digit = (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f');
    return shape == '-' ? c == '-' : digit;
  };
  return text.size() == kShape.size() && std::ranges::equal(text, kShape, fits);
}

std::string TraceOf(const grpc::CallbackServerContext& context) {
  const auto trace = context.client_metadata().find("traceparent");
  if (trace == context.client_metadata().end()) return std::string();
  const std::string_view text(trace->second.data(), trace->second.size());
  return IsTraceparent(text) ? std::string(text) : std::string();
}

std::string FullName(const Method& method) { return absl::StrCat("/bccskel.v1.", method.name); }

// The log's field for a name.
std::string_view FieldOf(const std::string& name) {
  if (name.starts_with("uploads/")) return "upload";
  if (name.starts_with("volumes/")) return "volume";
  return name.empty() || name.starts_with("jobs/") ? "job" : "name";
}

LogLevel LevelOf(const Method& method, const absl::Status& end) {
  if (!end.ok()) return LogLevel::kWarning;
  return method.kind == Method::Kind::kQuestion ? LogLevel::kDebug : LogLevel::kInfo;
}

absl::Status Stopping() {
  return CallError(Reason::kDraining, "the server is stopping and aborts the call");
}

std::optional<std::string_view> AuthorizationOf(const grpc::CallbackServerContext& context) {
  const auto header = context.client_metadata().find("authorization");
  if (header == context.client_metadata().end()) return std::nullopt;
  return std::string_view(header->second.data(), header->second.size());
}

// Longer than any valid name.
constexpr size_t kMaxNameBytes = 128;

absl::Status CheckName(const CallGate::Name& name) {
  if (name.name.empty()) return InvalidField(name.field, "must be set");
  if (name.name.size() <= kMaxNameBytes) return absl::OkStatus();
  return InvalidField(name.field,
                      absl::StrCat(name.name.size(), " bytes, the limit is ", kMaxNameBytes));
}

}  // namespace

absl::Status CallFacts::CancelStatus() const {
  if (gate->is_cut_off()) return Stopping();
  return Clock::now() >= deadline ? absl::DeadlineExceededError("the call's deadline has passed")
                                  : absl::CancelledError("the caller cancelled the call");
}

void CallFacts::LogAccepted(const std::string& job, uint64_t volume_bytes) const {
  Log(LogLevel::kInfo, "job accepted",
      {{"method", FullName(method)},
       {"job", job},
       {"tenant", tenant},
       {"volume_bytes", static_cast<int64_t>(volume_bytes)},
       {"traceparent", trace}});
}

void CallFacts::LogEnded(const std::string& subject, const absl::Status& status) const {
  Log(LevelOf(method, status), "call ended",
      {{"method", FullName(method)},
       {FieldOf(subject), subject},
       {"tenant", tenant},
       {"code", absl::StatusCodeToString(status.code())},
       {"reason", ReasonNameOf(status)},
       {"message", std::string(status.message())},
       {"seconds", std::chrono::duration<double>(Clock::now() - started).count()},
       {"traceparent", trace}});
}

std::optional<Sha256Digest> DigestOf(const v1::VolumeFinish& finish) {
  Sha256Digest digest;
  const std::string& bytes = finish.sha256();
  if (bytes.size() != digest.bytes.size()) return std::nullopt;
  std::copy(bytes.begin(), bytes.end(), digest.bytes.begin());
  return digest;
}

void OpenStreams::Add(const std::shared_ptr<OpenStream>& call, const CallFacts& facts) {
  std::unique_lock lock(mutex_);
  calls_[call.get()] = {call, facts.authorization, facts.tenant, facts.tokens};
  const absl::Status ended = ended_;
  lock.unlock();
  if (!ended.ok()) call->EndEarly(ended);
}

void OpenStreams::Remove(const OpenStream& call) {
  std::lock_guard lock(mutex_);
  calls_.erase(&call);
}

absl::Status OpenStreams::CheckToken(Entry& entry, uint64_t generation) const {
  if (std::exchange(entry.tokens, generation) == generation) return absl::OkStatus();
  const absl::StatusOr<Caller> caller = callers_.Identify(entry.authorization);
  if (caller.ok() && caller->tenant == entry.tenant) return absl::OkStatus();
  return CallError(Reason::kTokenInvalid, "the token of this call is no longer accepted");
}

void OpenStreams::EndAll(const absl::Status& why) {
  std::vector<std::shared_ptr<OpenStream>> calls;
  {
    std::lock_guard lock(mutex_);
    ended_ = why;
    for (const auto& [pointer, entry] : calls_) {
      if (auto call = entry.call.lock()) calls.push_back(std::move(call));
    }
  }
  for (const auto& call : calls) call->EndEarly(why);
}

void OpenStreams::EnforceLimits() {
  using Seen = std::pair<std::shared_ptr<OpenStream>, absl::Status>;
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
    if (status.ok()) status = call->CheckCaller(now, timeouts_);
    if (!status.ok()) call->EndEarly(status);
  }
}

void CallGate::CutOff(std::chrono::milliseconds timeout) {
  cut_off_ = true;
  open_streams_.EndAll(Stopping());
  unanswered_.WaitForAll(timeout);
}

absl::StatusOr<CallFacts> CallGate::Enter(const grpc::CallbackServerContext& context,
                                          const Method& method) const {
  CallFacts facts = {.method = method,
                     .deadline = SteadyDeadline(context.deadline()),
                     .trace = TraceOf(context),
                     .context = &context,
                     .gate = this};
  if (cut_off_) return Refused(facts, Stopping());
  // Before the check, so that a file that changes meanwhile leads to another one.
  facts.tokens = callers_.generation();
  const auto authorization = AuthorizationOf(context);
  facts.authorization = authorization.value_or(std::string_view());
  absl::StatusOr<Caller> caller = callers_.Identify(authorization);
  if (!caller.ok()) {
    facts.tenant.clear();
    const Reason reason = authorization.has_value() ? Reason::kTokenInvalid : Reason::kTokenMissing;
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
  return Refused(facts, CallError(Reason::kAdminOnly, "this call needs an admin's token"));
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

absl::StatusOr<DurableCall> CallGate::EnterDurable(const grpc::CallbackServerContext& context,
                                                   const Method& method,
                                                   const std::optional<Name>& name) const {
  BCCSKEL_ASSIGN_OR_RETURN(CallFacts facts, Enter(context, method));
  if (durable_jobs_ == nullptr) {
    return Refused(facts, CallError(Reason::kNotDurable,
                                    "this server keeps nothing on disk: it was started without "
                                    "--data-dir, so there are neither uploads nor durable jobs"));
  }
  const absl::Status checked = name.has_value() ? CheckName(*name) : absl::OkStatus();
  if (!checked.ok()) return Refused(facts, checked);
  return DurableCall{std::move(facts), *durable_jobs_};
}

}  // namespace bccskel::server
