#include "server/calls/unparsed_requests.h"

#include <google/protobuf/descriptor.h>

#include <algorithm>

#include "absl/strings/str_split.h"
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

grpc::experimental::Interceptor* UnparsedRequests::CreateServerInterceptor(
    grpc::experimental::ServerRpcInfo* info) {
  const std::vector<std::string> parts =
      absl::StrSplit(info->method(), '/');  // "", service, method
  if (parts.size() != 3 || std::ranges::find(services_, parts[1]) == services_.end()) {
    return nullptr;
  }
  const auto* const known = google::protobuf::DescriptorPool::generated_pool()->FindMethodByName(
      parts[1] + "." + parts[2]);
  return known == nullptr ? nullptr : new NameUnparsed;
}

}  // namespace bccskel::server
