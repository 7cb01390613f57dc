#ifndef BCCSKEL_SERVER_METRICS_CALL_METER_H_
#define BCCSKEL_SERVER_METRICS_CALL_METER_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/server_interceptor.h>

#include <string>

#include "server/metrics/server_metrics.h"

namespace bccskel::server {

// Counts every call to every service of a listener, whatever its handler does.
class CallMeter : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  // Needs: `metrics` outlives the listener.
  explicit CallMeter(ServerMetrics& metrics) : metrics_(metrics) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  ServerMetrics& metrics_;
};

// Counts begin at 0 for each method of the service.
void ExpectCallsOf(const std::string& service, ServerMetrics& metrics);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_CALL_METER_H_
