#include "server/metrics/call_meter.h"

#include <google/protobuf/descriptor.h>

#include <chrono>

#include "absl/status/status.h"
#include "bccskel/v1/rpc_details.pb.h"
#include "proto/wire/error_details.h"
#include "server/calls/unparsed_requests.h"

namespace bccskel::server {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;
using Clock = std::chrono::steady_clock;

// "OK", "NOT_FOUND", ...
std::string CodeName(const grpc::Status& status) {
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
}

// Of the ErrorInfo in the details; empty where there is none.
std::string ReasonNameOf(const grpc::Status& status) {
  if (status.ok() || status.error_details().empty()) return std::string();
  v1::Status message;
  if (!message.ParseFromString(status.error_details())) return std::string();
  const auto info = wire::ErrorInfoOf(wire::FromRpcStatus(message));
  return info.has_value() ? info->reason() : std::string();
}

class Meter : public grpc::experimental::Interceptor {
 public:
  Meter(ServerMetrics& metrics, const char* method) : metrics_(metrics), method_(method) {}

  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      const grpc::Status status = methods->GetSendStatus();
      metrics_.Count(EndedCall{.method = method_,
                               .code = CodeName(status),
                               .reason = ReasonNameOf(status),
                               .seconds = Clock::now() - start_});
    }
    methods->Proceed();
  }

 private:
  ServerMetrics& metrics_;
  const char* const method_;
  const Clock::time_point start_ = Clock::now();
};

}  // namespace

grpc::experimental::Interceptor* CallMeter::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  // Series stay for ever: not one for every name that callers make up.
  return new Meter(metrics_, IsKnownMethod(info->method()) ? info->method() : "unknown");
}

void ExpectCallsOf(const std::string& service, ServerMetrics& metrics) {
  const auto* const found =
      google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(service);
  for (int n = 0; found != nullptr && n < found->method_count(); ++n) {
    metrics.ExpectCalls("/" + service + "/" + found->method(n)->name());
  }
}

}  // namespace bccskel::server
