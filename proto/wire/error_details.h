#ifndef BCCSKEL_PROTO_WIRE_ERROR_DETAILS_H_
#define BCCSKEL_PROTO_WIRE_ERROR_DETAILS_H_

#include <map>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/time/time.h"
#include "bccskel/v1/rpc_details.pb.h"

// Details of an error travel inside absl::Status as payloads: the key is the detail's type URL, the
// value its serialized message. So code without access to gRPC can name the wrong field, and the
// server and the client each need one generic translation.

namespace bccskel::wire {

// The longest error message on the wire, in bytes; longer ones are truncated.
inline constexpr size_t kMaxErrorMessageBytes = 1024;

// Each returns the status with one more detail. Needs: !status.ok().
absl::Status WithReason(absl::Status status, const std::string& reason,
                        const std::map<std::string, std::string>& metadata = {});
// BadRequest; the description is the status's message.
absl::Status WithField(absl::Status status, const std::string& field);
// QuotaFailure; the description is the status's message.
absl::Status WithQuota(absl::Status status, const std::string& limit);
absl::Status WithRetryDelay(absl::Status status, absl::Duration delay);

// INVALID_ARGUMENT with reason FIELD_INVALID: "<field>: <description>".
absl::Status InvalidField(const std::string& field, const std::string& description);

// nullopt if the status has no such detail or it cannot be parsed.
std::optional<v1::ErrorInfo> ErrorInfoOf(const absl::Status& status);
std::optional<v1::BadRequest> BadRequestOf(const absl::Status& status);
std::optional<v1::QuotaFailure> QuotaFailureOf(const absl::Status& status);
std::optional<absl::Duration> RetryDelayOf(const absl::Status& status);

// The form of an error in the trailer `grpc-status-details-bin`. Code and message are those of the
// status, the message truncated to kMaxErrorMessageBytes. Payloads that are not messages are
// omitted.
v1::Status ToRpcStatus(const absl::Status& status);
absl::Status FromRpcStatus(const v1::Status& status);

}  // namespace bccskel::wire

#endif  // BCCSKEL_PROTO_WIRE_ERROR_DETAILS_H_
