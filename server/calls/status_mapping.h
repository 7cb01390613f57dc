#ifndef BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_
#define BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/rpc_details.pb.h"

namespace bccskel::server {

// The only place that creates a grpc::Status. It always carries an ErrorInfo; the error's other
// details (errors/call_error.h) become BadRequest, QuotaFailure and RetryInfo.
grpc::Status ToGrpcStatus(const absl::Status& status);
// The same for an error that travels in a message. Needs: !status.ok().
v1::Status ToStatusMessage(const absl::Status& status);
// The reason in the error's ErrorInfo; empty for OK.
std::string ReasonNameOf(const absl::Status& status);

// A storage error as callers may see it: a full disk names the limit; paths and statements of other
// errors go to the log only.
absl::Status StorageError(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_
