#ifndef BCCSKEL_SERVER_STATUS_MAPPING_H_
#define BCCSKEL_SERVER_STATUS_MAPPING_H_

#include <grpcpp/support/status.h>

#include "absl/status/status.h"

namespace bccskel::server {

// The only place where a grpc::Status is made. Details that the status carries (wire/error_details)
// go into the trailer; a Refusal becomes QuotaFailure or RetryInfo; ErrorInfo is always there.
grpc::Status ToGrpcStatus(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STATUS_MAPPING_H_
