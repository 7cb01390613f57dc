#ifndef BCCSKEL_CLIENT_GRPC_DURABLE_STUB_H_
#define BCCSKEL_CLIENT_GRPC_DURABLE_STUB_H_

#include <grpcpp/grpcpp.h>

#include <memory>

#include "client/durable_client.h"

namespace bccskel::client {

std::unique_ptr<DurableStub> MakeDurableStub(const std::shared_ptr<grpc::Channel>& channel);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_GRPC_DURABLE_STUB_H_
