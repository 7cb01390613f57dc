#include "server/calls/status_mapping.h"

#include <map>
#include <string>
#include <utility>

#include "proto/wire/error_details.h"
#include "server/errors/call_error.h"
#include "server/logging/json_log.h"
#include "server/store/file_io.h"

namespace bccskel::server {
namespace {

// Most jobs free their place within seconds; clients add jitter and back off.
const absl::Duration kRetryDelay = absl::Seconds(1);

absl::Status WithAllDetails(const absl::Status& status) {
  // Drop internal payloads, such as the reason.
  absl::Status detailed = wire::FromRpcStatus(wire::ToRpcStatus(status));
  if (wire::ErrorInfoOf(detailed).has_value()) return detailed;  // proto/wire found the error
  const Reason reason = ReasonOf(status).value_or(DefaultReason(status.code()));
  const ErrorDetails details = DetailsOf(status);
  std::map<std::string, std::string> metadata;
  if (!details.key.empty()) metadata[details.key] = details.value;
  detailed = wire::WithReason(std::move(detailed), NameOf(reason), metadata);
  if (!details.quota.empty()) detailed = wire::WithQuota(std::move(detailed), details.quota);
  if (!details.field.empty()) detailed = wire::WithField(std::move(detailed), details.field);
  return IsWorthARetry(reason) ? wire::WithRetryDelay(std::move(detailed), kRetryDelay) : detailed;
}

}  // namespace

v1::Status ToStatusMessage(const absl::Status& status) {
  return wire::ToRpcStatus(WithAllDetails(status));
}

grpc::Status ToGrpcStatus(const absl::Status& status) {
  if (status.ok()) return grpc::Status::OK;
  const v1::Status detailed = ToStatusMessage(status);
  return grpc::Status(static_cast<grpc::StatusCode>(detailed.code()), detailed.message(),
                      detailed.SerializeAsString());
}

std::string ReasonNameOf(const absl::Status& status) {
  if (status.ok()) return std::string();
  return wire::ErrorInfoOf(WithAllDetails(status))->reason();
}

absl::Status StorageError(const absl::Status& status) {
  if (status.ok() || StatesReason(status)) return status;
  if (IsMissingFile(status)) {
    Log(LogLevel::kError, "storage failed", {{"message", std::string(status.message())}});
    return absl::UnavailableError("a file of the server's stored data is missing at the moment");
  }
  if (!absl::IsInternal(status)) return WithDiskReason(status);
  Log(LogLevel::kError, "storage failed", {{"message", std::string(status.message())}});
  return absl::InternalError("the server cannot read or write its stored data");
}

}  // namespace bccskel::server
