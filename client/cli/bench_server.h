#ifndef BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_
#define BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_

#include <chrono>
#include <cstdint>
#include <stop_token>
#include <vector>

#include "absl/status/statusor.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"

namespace bccskel::cli {

// What some clients at the same time saw of a server.
struct ServerMeasurement {
  int clients = 0;
  uint64_t points = 0;        // of the volume
  uint64_t volume_bytes = 0;  // as sent
  double seconds = 0;
  uint64_t refused = 0;                           // UNAVAILABLE: tried again after a pause
  std::vector<std::chrono::nanoseconds> latency;  // of each call that gave a skeleton; ascending
};

// The latency that `share` of the calls did not exceed, 0 to 1. Needs: a call.
std::chrono::nanoseconds Percentile(const ServerMeasurement& measured, double share);

// Each client has its own connection and sends `volume` again as soon as it has the skeleton. What
// comes back is checked as always. A first call of each is not counted.
// Errors: of the first call that fails otherwise than by UNAVAILABLE with a delay.
absl::StatusOr<ServerMeasurement> MeasureServer(const client::Endpoint& endpoint,
                                                const client::EncodedVolume& volume, int clients,
                                                std::chrono::milliseconds duration,
                                                const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_
