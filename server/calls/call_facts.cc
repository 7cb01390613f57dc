#include "server/calls/call_facts.h"

#include <algorithm>
#include <string_view>

#include "absl/strings/str_cat.h"
#include "server/logging/json_log.h"
#include "server/calls/lasting_calls.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using Clock = CallFacts::Clock;

// gRPC states deadlines in wall-clock time; jobs must not be moved by clock adjustments.
Clock::time_point SteadyDeadline(std::chrono::system_clock::time_point deadline) {
  const auto left = deadline - std::chrono::system_clock::now();
  constexpr auto kFar = std::chrono::hours(24 * 365);
  return left > kFar ? Clock::time_point::max() : Clock::now() + left;
}

// W3C Trace Context: version, trace, parent and flags. What is none is left out of the log, which
// is no place for whatever callers send.
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
  if (name.compare(0, 8, "uploads/") == 0) return "upload";
  return name.compare(0, 8, "volumes/") == 0 ? "volume" : "job";
}

LogLevel LevelOf(const Method& method, const absl::Status& end) {
  if (!end.ok()) return LogLevel::kWarning;
  return method.kind == Method::Kind::kQuestion ? LogLevel::kDebug : LogLevel::kInfo;
}

}  // namespace

CallFacts FactsOf(const grpc::CallbackServerContext& context) {
  return {.deadline = SteadyDeadline(context.deadline()), .trace = TraceOf(context)};
}

void CallFacts::LookAfter(const std::shared_ptr<LastingCall>& call) const {
  if (lasting != nullptr) lasting->Add(call, *this);
}

void CallFacts::Leave(const LastingCall& call) const {
  if (lasting != nullptr) lasting->Remove(call);
}

absl::Status CallFacts::CancelStatus() const {
  if (cut_off != nullptr && *cut_off) {
    return CallError(Reason::kDraining, "the server stops and cuts the call off");
  }
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

}  // namespace bccskel::server
