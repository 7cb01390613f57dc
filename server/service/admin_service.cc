#include "server/service/admin_service.h"

namespace bccskel::server {

grpc::ServerUnaryReactor* AdminService::GetServerStatus(grpc::CallbackServerContext* context,
                                                        const v1::GetServerStatusRequest*,
                                                        v1::GetServerStatusResponse* response) {
  const absl::Status entered = gate_.EnterAsAdmin(*context).status();
  if (entered.ok()) *response = status_();
  return EndUnary(*context, entered);
}

}  // namespace bccskel::server
