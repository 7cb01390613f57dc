#ifndef BCCSKEL_SERVER_METRICS_CALL_METER_H_
#define BCCSKEL_SERVER_METRICS_CALL_METER_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/server_interceptor.h>

#include <string>
#include <utility>
#include <vector>

#include "server/metrics/server_metrics.h"

namespace bccskel::server {

// Sees the status of every call to every service of a listener, whatever its handler does.
// - Counts the calls.
// - A request that gRPC cannot parse never reaches its handler: gRPC answers UNIMPLEMENTED, without
//   a message. The meter changes that to INVALID_ARGUMENT, with details as every other error.
class CallMeter : public grpc::experimental::ServerInterceptorFactoryInterface {
 public:
  // `services` of ours by their full names. `metrics` may be null: nothing is counted.
  // Needs: `metrics` outlives the listener.
  CallMeter(std::vector<std::string> services, ServerMetrics* metrics)
      : services_(std::move(services)), metrics_(metrics) {}
  grpc::experimental::Interceptor* CreateServerInterceptor(
      grpc::experimental::ServerRpcInfo* info) override;

 private:
  const std::vector<std::string> services_;
  ServerMetrics* const metrics_;
};

// Counts begin at 0 for each method of the service.
void ExpectCallsOf(const std::string& service, ServerMetrics& metrics);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_CALL_METER_H_
