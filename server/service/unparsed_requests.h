#ifndef BCCSKEL_SERVER_SERVICE_UNPARSED_REQUESTS_H_
#define BCCSKEL_SERVER_SERVICE_UNPARSED_REQUESTS_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/server_interceptor.h>

namespace bccskel::server {

// A request that gRPC cannot parse never reaches its handler: gRPC answers UNIMPLEMENTED, without a
// word. This makes it the INVALID_ARGUMENT that it is, with details as every other error.
class UnparsedRequests : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVICE_UNPARSED_REQUESTS_H_
