#ifndef BCCSKEL_CORE_EXEC_STAGE_CLOCK_H_
#define BCCSKEL_CORE_EXEC_STAGE_CLOCK_H_

#include <chrono>

namespace bccskel::exec {

// Measures the wall time of consecutive stages.
class StageClock {
 public:
  using Duration = std::chrono::nanoseconds;

  // Since the last call, or since the clock was made.
  Duration Lap() {
    const Clock::time_point now = Clock::now();
    const Duration lap = now - last_;
    last_ = now;
    return lap;
  }
  // All laps together.
  Duration Total() const { return last_ - start_; }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_STAGE_CLOCK_H_
