#ifndef BCCSKEL_SERVER_CALLS_ADMIN_SERVICE_H_
#define BCCSKEL_SERVER_CALLS_ADMIN_SERVICE_H_

#include <functional>

#include "bccskel/v1/admin_service.grpc.pb.h"
#include "server/calls/call_gate.h"

namespace bccskel::server {

class AdminService final : public v1::AdminService::CallbackService {
 public:
  // Makes the answer at once. Threads: must be safe.
  using StatusSource = std::function<v1::GetServerStatusResponse()>;

  // Needs: `gate`, and what `status` asks, outlive the service's calls.
  AdminService(const CallGate& gate, StatusSource status)
      : gate_(gate), status_(std::move(status)) {}

  grpc::ServerUnaryReactor* GetServerStatus(grpc::CallbackServerContext* context,
                                            const v1::GetServerStatusRequest* request,
                                            v1::GetServerStatusResponse* response) override;

 private:
  const CallGate& gate_;
  const StatusSource status_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_ADMIN_SERVICE_H_
