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
  ClockGuard(std::chrono::seconds believable_leap, std::optional<Time> last, Steady now)
      : believable_leap_(believable_leap), last_(last), last_steady_(now) {}

  // Whether to believe `now`: it has advanced as the steady clock has, or its last leap is long
  // past.
  bool Believes(Time now, Steady steady) {
    if (last_.has_value() && now - *last_ > (steady - last_steady_) + believable_leap_) {
      doubted_until_ = steady + kTimeToCorrect;
    }
    last_ = now;
    last_steady_ = steady;
    return steady >= doubted_until_;
  }

 private:
  static constexpr std::chrono::hours kTimeToCorrect{1};

  const std::chrono::seconds believable_leap_;
  std::optional<Time> last_;
  Steady last_steady_;
  Steady doubted_until_ = Steady::min();
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_CLOCK_GUARD_H_
