#ifndef BCCSKEL_SERVER_SERVER_STATUS_H_
#define BCCSKEL_SERVER_SERVER_STATUS_H_

#include <chrono>

#include "bccskel/v1/admin_service.pb.h"
#include "server/metrics/server_metrics.h"

namespace bccskel::server {

// What AdminService answers, for a server that runs since `started`.
v1::GetServerStatusResponse StatusOf(const ServerMetrics& metrics,
                                     std::chrono::steady_clock::time_point started);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_SERVER_STATUS_H_
