#include "server/service/ledger_status.h"

#include <map>
#include <string>
#include <utility>

#include "proto/wire/error_details.h"
#include "server/admission/refusal.h"
#include "server/durable/fault.h"
#include "server/logging/json_log.h"

namespace bccskel::server {
namespace {

// Null where the code has a reason for all calls (see status_mapping.cc).
const char* ReasonOfCode(absl::StatusCode code, const LedgerReasons& reasons) {
  switch (code) {
    case absl::StatusCode::kNotFound:
      return "NOT_FOUND";
    case absl::StatusCode::kAborted:
      return "SECOND_WRITER";
    case absl::StatusCode::kAlreadyExists:
      return reasons.exists;
    case absl::StatusCode::kFailedPrecondition:
      return reasons.precondition;
    case absl::StatusCode::kDataLoss:
      return "STORED_DATA_DAMAGED";
    default:
      return nullptr;
  }
}

// "field: what is wrong with it"
absl::Status WithFieldOfMessage(absl::Status status) {
  const std::string message(status.message());
  return wire::WithField(std::move(status), message.substr(0, message.find(':')));
}

absl::Status WithDetails(absl::Status status, const Fault& fault) {
  std::map<std::string, std::string> metadata;
  if (!fault.key.empty()) metadata[fault.key] = fault.value;
  status = wire::WithReason(std::move(status), fault.reason, metadata);
  if (fault.reason == kDiskFull) return wire::WithQuota(std::move(status), fault.value);
  return fault.reason == "FIELD_INVALID" ? WithFieldOfMessage(std::move(status)) : status;
}

// Paths and statements are for the log.
absl::Status WithoutDetails(const absl::Status& status) {
  Log(LogLevel::kError, "storage failed", {{"message", std::string(status.message())}});
  return absl::InternalError("the server cannot read or write what it keeps");
}

}  // namespace

absl::Status WithLedgerReason(absl::Status status, const LedgerReasons& reasons) {
  if (status.ok() || RefusalOf(status).has_value() || wire::ErrorInfoOf(status).has_value()) {
    return status;
  }
  status = WithDiskFault(status);
  if (const auto fault = FaultOf(status)) return WithDetails(std::move(status), *fault);
  if (absl::IsInternal(status)) return WithoutDetails(status);
  const char* const reason = ReasonOfCode(status.code(), reasons);
  return reason == nullptr ? status : wire::WithReason(std::move(status), reason);
}

}  // namespace bccskel::server
