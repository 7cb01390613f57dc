#include "proto/wire/error_details.h"

#include "absl/strings/cord.h"
#include "absl/strings/match.h"
#include "absl/strings/str_cat.h"
#include "proto/wire/duration.h"

namespace bccskel::wire {
namespace {

constexpr char kDomain[] = "bccskel";
constexpr char kTypeUrlPrefix[] = "type.googleapis.com/";
constexpr char kErrorInfo[] = "type.googleapis.com/google.rpc.ErrorInfo";
constexpr char kBadRequest[] = "type.googleapis.com/google.rpc.BadRequest";
constexpr char kQuotaFailure[] = "type.googleapis.com/google.rpc.QuotaFailure";
constexpr char kRetryInfo[] = "type.googleapis.com/google.rpc.RetryInfo";

template <typename Message>
absl::Status WithPayload(absl::Status status, const char* type_url, const Message& message) {
  status.SetPayload(type_url, absl::Cord(message.SerializeAsString()));
  return status;
}

template <typename Message>
std::optional<Message> PayloadOf(const absl::Status& status, const char* type_url) {
  const absl::optional<absl::Cord> payload = status.GetPayload(type_url);
  Message message;
  if (!payload.has_value() || !message.ParseFromString(std::string(*payload))) return std::nullopt;
  return message;
}

// Truncates to the limit without splitting a UTF-8 sequence.
std::string CutMessage(std::string message) {
  if (message.size() <= kMaxErrorMessageBytes) return message;
  size_t end = kMaxErrorMessageBytes;
  while (end > 0 && (static_cast<unsigned char>(message[end]) & 0xC0) == 0x80) --end;
  message.resize(end);
  return message;
}

}  // namespace

absl::Status WithReason(absl::Status status, const std::string& reason,
                        const std::map<std::string, std::string>& metadata) {
  v1::ErrorInfo info;
  info.set_reason(reason);
  info.set_domain(kDomain);
  info.mutable_metadata()->insert(metadata.begin(), metadata.end());
  return WithPayload(std::move(status), kErrorInfo, info);
}

absl::Status WithField(absl::Status status, const std::string& field) {
  v1::BadRequest bad_request = BadRequestOf(status).value_or(v1::BadRequest());
  v1::BadRequest::FieldViolation& violation = *bad_request.add_field_violations();
  violation.set_field(field);
  violation.set_description(CutMessage(std::string(status.message())));
  return WithPayload(std::move(status), kBadRequest, bad_request);
}

absl::Status WithQuota(absl::Status status, const std::string& limit) {
  v1::QuotaFailure failure = QuotaFailureOf(status).value_or(v1::QuotaFailure());
  v1::QuotaFailure::Violation& violation = *failure.add_violations();
  violation.set_subject(limit);
  violation.set_description(CutMessage(std::string(status.message())));
  return WithPayload(std::move(status), kQuotaFailure, failure);
}

absl::Status WithRetryDelay(absl::Status status, absl::Duration delay) {
  v1::RetryInfo info;
  *info.mutable_retry_delay() = DurationMessage(absl::ToChronoNanoseconds(delay));
  return WithPayload(std::move(status), kRetryInfo, info);
}

absl::Status InvalidField(const std::string& field, const std::string& description) {
  absl::Status status = absl::InvalidArgumentError(absl::StrCat(field, ": ", description));
  return WithField(WithReason(std::move(status), "FIELD_INVALID"), field);
}

std::optional<v1::ErrorInfo> ErrorInfoOf(const absl::Status& status) {
  return PayloadOf<v1::ErrorInfo>(status, kErrorInfo);
}

std::optional<v1::BadRequest> BadRequestOf(const absl::Status& status) {
  return PayloadOf<v1::BadRequest>(status, kBadRequest);
}

std::optional<v1::QuotaFailure> QuotaFailureOf(const absl::Status& status) {
  return PayloadOf<v1::QuotaFailure>(status, kQuotaFailure);
}

std::optional<absl::Duration> RetryDelayOf(const absl::Status& status) {
  const std::optional<v1::RetryInfo> info = PayloadOf<v1::RetryInfo>(status, kRetryInfo);
  if (!info.has_value()) return std::nullopt;
  return absl::Seconds(info->retry_delay().seconds()) +
         absl::Nanoseconds(info->retry_delay().nanos());
}

v1::Status ToRpcStatus(const absl::Status& status) {
  v1::Status message;
  message.set_code(static_cast<int32_t>(status.code()));
  message.set_message(CutMessage(std::string(status.message())));
  status.ForEachPayload([&message](absl::string_view type_url, const absl::Cord& payload) {
    if (!absl::StartsWith(type_url, kTypeUrlPrefix)) return;
    google::protobuf::Any& detail = *message.add_details();
    detail.set_type_url(std::string(type_url));
    detail.set_value(std::string(payload));
  });
  return message;
}

absl::Status FromRpcStatus(const v1::Status& message) {
  absl::Status status(static_cast<absl::StatusCode>(message.code()), message.message());
  for (const google::protobuf::Any& detail : message.details()) {
    status.SetPayload(detail.type_url(), absl::Cord(detail.value()));
  }
  return status;
}

}  // namespace bccskel::wire
