#include "server/service/unparsed_requests.h"

#include "absl/strings/match.h"
#include "proto/wire/error_details.h"
#include "server/status_mapping.h"

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
        methods->ModifySendStatus(ToGrpcStatus(wire::WithReason(
            absl::InvalidArgumentError("the request cannot be parsed as a message of this method"),
            "REQUEST_MALFORMED")));
      }
    }
    methods->Proceed();
  }
};

}  // namespace

grpc::experimental::Interceptor* UnparsedRequests::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  return absl::StartsWith(info->method(), "/bccskel.") ? new NameUnparsed : nullptr;
}

}  // namespace bccskel::server
