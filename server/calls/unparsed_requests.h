#ifndef BCCSKEL_SERVER_CALLS_UNPARSED_REQUESTS_H_
#define BCCSKEL_SERVER_CALLS_UNPARSED_REQUESTS_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/server_interceptor.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace bccskel::server {

// Whether there is such a method, "/package.Service/Method", in the code of this program. Callers
// may ask for any other name.
bool IsKnownMethod(std::string_view method);

// A request that gRPC cannot parse never reaches its handler: gRPC answers UNIMPLEMENTED, without a
// word. This makes it the INVALID_ARGUMENT that it is, with details as every other error.
class UnparsedRequests : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  // `services` by their full names: for their methods only.
  explicit UnparsedRequests(std::vector<std::string> services) : services_(std::move(services)) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  const std::vector<std::string> services_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_UNPARSED_REQUESTS_H_
