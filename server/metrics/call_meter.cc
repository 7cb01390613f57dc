#include "server/metrics/call_meter.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>
#include <chrono>
#include <string_view>
#include <utility>

#include "absl/status/status.h"
#include "bccskel/v1/rpc_details.pb.h"
#include "proto/wire/error_details.h"
#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using grpc::experimental::InterceptionHookPoints;
using grpc::experimental::InterceptorBatchMethods;
using Clock = std::chrono::steady_clock;

// "OK", "NOT_FOUND", ...
std::string CodeName(const grpc::Status& status) {
  return absl::StatusCodeToString(static_cast<absl::StatusCode>(status.error_code()));
}

// The reason in the ErrorInfo of the details; empty if there is none.
std::string ReasonNameOf(const grpc::Status& status) {
  if (status.ok() || status.error_details().empty()) return std::string();
  v1::Status message;
  if (!message.ParseFromString(status.error_details())) return std::string();
  const auto info = wire::ErrorInfoOf(wire::FromRpcStatus(message));
  return info.has_value() ? info->reason() : std::string();
}

// Whether this program has a method "/package.Service/Method". Callers may request any other name.
bool IsKnownMethod(std::string_view method) {
  // gRPC's health service is not among the generated descriptors.
  if (method == "/grpc.health.v1.Health/Check" || method == "/grpc.health.v1.Health/Watch") {
    return true;
  }
  std::string name(method.substr(std::min<size_t>(method.size(), 1)));
  std::ranges::replace(name, '/', '.');
  const auto* const found =
      google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(name);
  return found != nullptr && method == "/" + found->service()->full_name() + "/" + found->name();
}

// Whether gRPC itself ended the call: this server's handlers never return UNIMPLEMENTED, and all
// their errors have details.
bool IsUnparsed(const grpc::Status& status) {
  return status.error_code() == grpc::StatusCode::UNIMPLEMENTED && status.error_details().empty();
}

enum class Whose { kOurs, kOthers };

class Meter : public grpc::experimental::Interceptor {
 public:
  Meter(ServerMetrics* metrics, const char* method, Whose whose)
      : metrics_(metrics), method_(method), whose_(whose) {}

  void Intercept(InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      grpc::Status status = methods->GetSendStatus();
      if (whose_ == Whose::kOurs && IsUnparsed(status)) {
        status = ToGrpcStatus(CallError(
            Reason::kRequestMalformed, "the request cannot be parsed as a message of this method"));
        methods->ModifySendStatus(status);
      }
      if (metrics_ != nullptr) Count(status);
    }
    methods->Proceed();
  }

 private:
  void Count(const grpc::Status& status) {
    metrics_->Count(EndedCall{.method = method_,
                              .code = CodeName(status),
                              .reason = ReasonNameOf(status),
                              .seconds = Clock::now() - start_});
  }

  ServerMetrics* const metrics_;
  const char* const method_;
  const Whose whose_;
  const Clock::time_point start_ = Clock::now();
};

class CallMeter : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  CallMeter(std::vector<std::string> services, ServerMetrics* metrics)
      : services_(std::move(services)), metrics_(metrics) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override {
    const std::string_view method = info->method();
    const bool known = IsKnownMethod(method);
    const bool ours = known && std::ranges::any_of(services_, [method](const std::string& service) {
                        return method.starts_with("/" + service + "/");
                      });
    // Series stay forever: callers must not create one for every name they invent.
    return new Meter(metrics_, known ? info->method() : "unknown",
                     ours ? Whose::kOurs : Whose::kOthers);
  }

 private:
  const std::vector<std::string> services_;
  ServerMetrics* const metrics_;
};

}  // namespace

std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> MakeCallMeter(
    std::vector<std::string> services, ServerMetrics* metrics) {
  return std::make_unique<CallMeter>(std::move(services), metrics);
}

void ExpectCallsOf(const std::string& service, ServerMetrics& metrics) {
  const auto* const found =
      google::protobuf::DescriptorPool::generated_pool()->FindServiceByName(service);
  for (int n = 0; found != nullptr && n < found->method_count(); ++n) {
    metrics.ExpectCalls("/" + service + "/" + found->method(n)->name());
  }
}

}  // namespace bccskel::server
