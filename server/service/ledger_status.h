#ifndef BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_
#define BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_

#include "absl/status/status.h"

namespace bccskel::server {

// The ledger's error with the details that callers get: its fault becomes ErrorInfo, and where it
// states none, its code says the reason. Errors that have ErrorInfo, and refusals, stay as they
// are. `precondition` and `exists` are the reasons of FAILED_PRECONDITION and ALREADY_EXISTS, which
// mean something else in each call.
struct LedgerReasons {
  const char* precondition = "FAILED_PRECONDITION";
  const char* exists = "ALREADY_EXISTS";
};
absl::Status WithLedgerReason(absl::Status status, const LedgerReasons& reasons = {});

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_
