#ifndef BCCSKEL_CLIENT_RETRY_POLICY_H_
#define BCCSKEL_CLIENT_RETRY_POLICY_H_

#include <chrono>
#include <functional>
#include <optional>
#include <random>
#include <stop_token>

#include "absl/status/status.h"

namespace bccskel::client {

// Retries only UNAVAILABLE, with exponential backoff. A server that names a delay (RetryInfo) is
// alive, so retries continue until the deadline; otherwise there are `max_attempts` attempts.
struct RetryPolicy {
  int max_attempts = 5;
  std::chrono::milliseconds first_pause{100};
  std::chrono::milliseconds longest_pause{5000};
  double growth = 2;
};

// The pauses of one call.
// Threads: one at a time.
class RetryPauses {
 public:
  explicit RetryPauses(const RetryPolicy& policy, uint32_t seed = std::random_device{}());

  // How long to wait after `error` before the next attempt; empty if the error is final. A pause is
  // at least the server's delay; jitter spreads it over the upper half of its length, so that
  // clients that failed together do not retry together.
  std::optional<std::chrono::milliseconds> Next(const absl::Status& error);

 private:
  RetryPolicy policy_;
  std::minstd_rand random_;
  int attempts_without_delay_ = 0;
  std::chrono::milliseconds pause_;
};

// How a retrying connection waits between attempts; tests replace it.
using Pause = std::function<void(std::chrono::milliseconds, const std::stop_token&)>;
// Waits; returns early when `stop` is requested.
void PauseFor(std::chrono::milliseconds duration, const std::stop_token& stop);

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_RETRY_POLICY_H_
