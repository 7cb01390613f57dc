#ifndef BCCSKEL_SERVER_DURABLE_CLOCK_GUARD_H_
#define BCCSKEL_SERVER_DURABLE_CLOCK_GUARD_H_

#include <chrono>
#include <optional>

#include "server/store/rows.h"

namespace bccskel::server {

// Suspends expiry after the clock has leapt ahead: a computer that wakes with a wrong clock usually
// has it corrected within minutes.
// Threads: one at a time.
class ClockGuard {
 public:
  using Steady = std::chrono::steady_clock::time_point;

  // `last`: the clock's last known time before, if any.
  ClockGuard(std::chrono::seconds max_clock_leap, std::optional<Time> last, Steady now)
      : max_clock_leap_(max_clock_leap), last_(last), last_steady_(now) {}

  // Whether to believe `now`: it has advanced as the steady clock has, or its last leap is long
  // past.
  bool Trusts(Time now, Steady steady) {
    if (last_.has_value() && now - *last_ > (steady - last_steady_) + max_clock_leap_) {
      distrusted_until_ = steady + kTimeToCorrect;
    }
    last_ = now;
    last_steady_ = steady;
    return steady >= distrusted_until_;
  }

 private:
  static constexpr std::chrono::hours kTimeToCorrect{1};

  const std::chrono::seconds max_clock_leap_;
  std::optional<Time> last_;
  Steady last_steady_;
  Steady distrusted_until_ = Steady::min();
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_CLOCK_GUARD_H_
