#ifndef BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_
#define BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_

#include "absl/status/status.h"

namespace bccskel::server {

// The ledger's error as callers may see it: a full disk names the limit; what cannot be read or
// written, with its paths and statements, is for the log.
absl::Status LedgerError(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_LEDGER_STATUS_H_
