#include "client/retry_policy.h"

#include <algorithm>
#include <condition_variable>
#include <mutex>

#include "proto/wire/error_details.h"

namespace bccskel::client {
namespace {

using std::chrono::milliseconds;

// The longest pause that a server can request.
constexpr absl::Duration kLongestDelay = absl::Hours(1);

milliseconds Scaled(milliseconds duration, double factor) {
  return milliseconds(
      static_cast<milliseconds::rep>(static_cast<double>(duration.count()) * factor));
}

}  // namespace

RetryPauses::RetryPauses(const RetryPolicy& policy, uint32_t seed)
    : policy_(policy), random_(seed), pause_(policy.first_pause) {}

std::optional<milliseconds> RetryPauses::Next(const absl::Status& error) {
  if (!absl::IsUnavailable(error)) return std::nullopt;
  const std::optional<absl::Duration> delay = wire::RetryDelayOf(error);
  if (!delay.has_value() && ++attempts_without_delay_ >= policy_.max_attempts) return std::nullopt;
  const double jitter = std::uniform_real_distribution<double>(0.5, 1.0)(random_);
  const milliseconds pause = Scaled(pause_, jitter);
  pause_ = std::min(Scaled(pause_, policy_.growth), policy_.longest_pause);
  if (!delay.has_value()) return pause;
  return pause +
         absl::ToChronoMilliseconds(std::clamp(*delay, absl::ZeroDuration(), kLongestDelay));
}

void PauseFor(milliseconds duration, const std::stop_token& stop) {
  std::mutex mutex;
  std::condition_variable_any never;
  std::unique_lock lock(mutex);
  never.wait_for(lock, stop, duration, [] { return false; });
}

}  // namespace bccskel::client
