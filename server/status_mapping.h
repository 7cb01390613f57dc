#ifndef BCCSKEL_SERVER_STATUS_MAPPING_H_
#define BCCSKEL_SERVER_STATUS_MAPPING_H_

#include <grpcpp/support/status.h>

#include <string>

#include "absl/status/status.h"
#include "bccskel/v1/rpc_details.pb.h"

namespace bccskel::server {

// The only place where a grpc::Status is made. Details that the status carries (wire/error_details)
// go into the trailer; a Refusal becomes QuotaFailure or RetryInfo; ErrorInfo is always there.
grpc::Status ToGrpcStatus(const absl::Status& status);

// The same for an error that is told in a message. Needs: !status.ok().
v1::Status ToStatusMessage(const absl::Status& status);

// The reason that its ErrorInfo states; empty for OK.
std::string ReasonOf(const absl::Status& status);

// An error with which a job has ended. Where it states no reason, a wrong argument is one in the
// volume's bytes, and too much of something is a volume over a limit that only decoding has shown.
absl::Status WithJobReason(const absl::Status& status);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STATUS_MAPPING_H_
