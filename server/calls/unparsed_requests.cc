#include "server/calls/unparsed_requests.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>

#include "server/calls/status_mapping.h"
#include "server/errors/call_error.h"

namespace bccskel::server {
namespace {

using grpc::experimental::InterceptionHookPoints;

class NameUnparsed : public grpc::experimental::Interceptor {
 public:
  void Intercept(grpc::experimental::InterceptorBatchMethods* methods) override {
    if (methods->QueryInterceptionHookPoint(InterceptionHookPoints::PRE_SEND_STATUS)) {
      const grpc::Status status = methods->GetSendStatus();
      // No handler of ours ends without details, or as UNIMPLEMENTED.
      if (status.error_code() == grpc::StatusCode::UNIMPLEMENTED &&
          status.error_details().empty()) {
        methods->ModifySendStatus(
            ToGrpcStatus(CallError(Reason::kRequestMalformed,
                                   "the request cannot be parsed as a message of this method")));
      }
    }
    methods->Proceed();
  }
};

}  // namespace

bool IsKnownMethod(std::string_view method) {
  // gRPC has the code of its health service elsewhere.
  if (method == "/grpc.health.v1.Health/Check" || method == "/grpc.health.v1.Health/Watch") {
    return true;
  }
  std::string name(method.substr(std::min<size_t>(method.size(), 1)));
  std::ranges::replace(name, '/', '.');
  const auto* const found =
      google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(name);
  return found != nullptr && method == "/" + found->service()->full_name() + "/" + found->name();
}

grpc::experimental::Interceptor* UnparsedRequests::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  const std::string_view method = info->method();
  const bool ours = std::ranges::any_of(services_, [method](const std::string& service) {
    return method.starts_with("/" + service + "/");
  });
  return ours && IsKnownMethod(method) ? new NameUnparsed : nullptr;
}

}  // namespace bccskel::server
