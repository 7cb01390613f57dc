#ifndef BCCSKEL_SERVER_METRICS_CALL_METER_H_
#define BCCSKEL_SERVER_METRICS_CALL_METER_H_

#include <grpcpp/grpcpp.h>
#include <grpcpp/support/server_interceptor.h>

#include <memory>
#include <string>
#include <vector>

#include "server/metrics/server_metrics.h"

namespace bccskel::server {

// Observes the status of every call to every service of a listener, whatever its handler does.
// - Counts the calls.
// - A request that gRPC cannot parse never reaches its handler: gRPC answers UNIMPLEMENTED without
//   a message. The meter changes that to INVALID_ARGUMENT, with details like every other error.
// `services` holds the full names of our services. `metrics` may be null: nothing is counted.
// Needs: `metrics` outlives the listener.
std::unique_ptr<grpc::experimental::ServerInterceptorFactoryInterface> MakeCallMeter(
    std::vector<std::string> services, ServerMetrics* metrics);

// Creates the counters of each method of the service, at 0.
void ExpectCallsOf(const std::string& service, ServerMetrics& metrics);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_METRICS_CALL_METER_H_
