#ifndef BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_
#define BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <stop_token>
#include <vector>

#include "absl/status/statusor.h"
#include "client/call_options.h"
#include "client/encoded_volume.h"
#include "client/endpoint.h"
#include "core/pipeline/skeletonize.h"
#include "core/pipeline/stage_timings.h"

namespace bccskel::cli {

// Where the time of one call went.
struct ServedCall {
  std::chrono::nanoseconds latency{0};  // from the first byte to the checked skeleton
  client::CallTimes way;
  StageTimings stages;
};

// What some clients at the same time saw of a server.
struct ServerMeasurement {
  int clients = 0;
  uint64_t points = 0;                 // of the volume
  uint64_t volume_bytes = 0;           // as sent
  std::chrono::nanoseconds encode{0};  // of the volume, before all calls
  double seconds = 0;
  uint64_t refused = 0;           // UNAVAILABLE: tried again after a pause
  std::vector<ServedCall> calls;  // that gave a skeleton, by ascending latency
};

// A part of a served call's time.
struct TimeShare {
  const char* name;
  std::function<std::chrono::nanoseconds(const ServedCall&)> of;
};
// In the order in which they begin. Decoding goes on while the volume arrives; "rest" is what is
// neither upload, stage nor download: the end of decoding, the queue, hand-over, the check.
std::vector<TimeShare> SharesOfCalls();

// The middle one of the calls' values. Needs: a call.
std::chrono::nanoseconds MedianOf(const ServerMeasurement& measured, const TimeShare& share);

// The latency that `share` of the calls did not exceed, 0 to 1. Needs: a call.
std::chrono::nanoseconds Percentile(const ServerMeasurement& measured, double share);

// Each client has its own connection and sends `volume` with `options` again as soon as it has the
// skeleton. What comes back is checked as always. A first call of each is not counted. Errors: of
// the first call that fails otherwise than by UNAVAILABLE with a delay.
absl::StatusOr<ServerMeasurement> MeasureServer(const client::Endpoint& endpoint,
                                                const client::EncodedVolume& volume,
                                                const SkeletonizeOptions& options, int clients,
                                                std::chrono::milliseconds duration,
                                                const std::stop_token& stop);

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_BENCH_SERVER_H_
