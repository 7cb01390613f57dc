#include "server/service/ledger_status.h"

#include <string>

#include "proto/wire/error_details.h"
#include "server/admission/refusal.h"
#include "server/durable/fault.h"
#include "server/logging/json_log.h"

namespace bccskel::server {

absl::Status LedgerError(const absl::Status& status) {
  if (status.ok() || RefusalOf(status).has_value() || wire::ErrorInfoOf(status).has_value()) {
    return status;
  }
  if (!absl::IsInternal(status) || FaultOf(status).has_value()) return WithDiskFault(status);
  Log(LogLevel::kError, "storage failed", {{"message", std::string(status.message())}});
  return absl::InternalError("the server cannot read or write what it keeps");
}

}  // namespace bccskel::server
