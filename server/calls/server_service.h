#ifndef BCCSKEL_SERVER_CALLS_SERVER_SERVICE_H_
#define BCCSKEL_SERVER_CALLS_SERVER_SERVICE_H_

#include "bccskel/v1/server_service.grpc.pb.h"
#include "server/durable/durable_options.h"
#include "server/jobs/job_pool.h"
#include "server/calls/call_gate.h"

namespace bccskel::server {

inline constexpr int kMaxMessageBytes = 4 << 20;

class ServerService final : public v1::ServerService::CallbackService {
 public:
  // Needs: `gate` outlives the service's calls.
  ServerService(const CallGate& gate, const JobPool::Limits& limits, const DurableOptions& durable)
      : gate_(gate), limits_(limits), durable_(durable) {}

  grpc::ServerUnaryReactor* GetCapabilities(grpc::CallbackServerContext* context,
                                            const v1::GetCapabilitiesRequest* request,
                                            v1::GetCapabilitiesResponse* response) override;

 private:
  const CallGate& gate_;
  const JobPool::Limits limits_;
  const DurableOptions durable_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SERVER_SERVICE_H_
