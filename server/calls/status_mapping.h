#ifndef BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_
#define BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/rpc_details.pb.h"

namespace bccskel::server {

// The only place where a grpc::Status is made. ErrorInfo is always there; the error's other details
// (errors/call_error.h) become BadRequest, QuotaFailure and RetryInfo.
grpc::Status ToGrpcStatus(const absl::Status& status);
// The same for an error that is told in a message. Needs: !status.ok().
v1::Status ToStatusMessage(const absl::Status& status);
// The reason that its ErrorInfo states; empty for OK.
std::string ReasonNameOf(const absl::Status& status);

// An error of what is stored as callers may see it: a full disk names the limit; what cannot be
// read or written, with its paths and statements, is for the log.
absl::Status StorageError(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_STATUS_MAPPING_H_
