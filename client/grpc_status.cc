#include "client/grpc_status.h"

#include "bccskel/v1/rpc_details.pb.h"
#include "proto/wire/error_details.h"

namespace bccskel::client {

absl::Status FromGrpcStatus(const grpc::Status& status) {
  if (status.ok()) return absl::OkStatus();
  const auto code = static_cast<absl::StatusCode>(status.error_code());  // the numbers are the same
  v1::Status details;
  if (!status.error_details().empty() && details.ParseFromString(status.error_details()) &&
      details.code() == static_cast<int>(status.error_code())) {
    return wire::FromRpcStatus(details);
  }
  // For calls that end on this side gRPC reports only the code.
  if (status.error_message() == "Deadline Exceeded") {
    return absl::Status(code, "the deadline passed before the server had answered");
  }
  if (status.error_message() == "CANCELLED") return absl::Status(code, "the call was cancelled");
  return absl::Status(code, status.error_message());
}

absl::Status WithoutForeignCancel(const absl::Status& error, const std::stop_token& stop) {
  const bool wanted = stop.stop_requested() || wire::ErrorInfoOf(error).has_value();
  if (!absl::IsCancelled(error) || wanted) return error;
  return absl::UnavailableError("the server has cancelled the call; it may be about to stop");
}

}  // namespace bccskel::client
