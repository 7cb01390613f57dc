#ifndef BCCSKEL_SERVER_DURABLE_RUN_PACE_H_
#define BCCSKEL_SERVER_DURABLE_RUN_PACE_H_

#include <algorithm>
#include <chrono>

namespace bccskel::server {

// Decides how many runs to begin before a place for them is free. Claiming a job, reading its
// volume and storing its result wait for the disk; meanwhile others compute. No other server can
// begin a claimed job, so only those likely to start soon are claimed.
// Threads: one at a time; callers pass the time.
class RunPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kMostAhead = 8;

  explicit RunPace(std::chrono::milliseconds soon) : soon_(soon) {}

  // A run that received its volume at `fed` has been computed at `now`.
  void Computed(Clock::time_point fed, Clock::time_point now) {
    const Clock::duration took = now - std::max(fed, last_);
    last_ = now;
    // Adopt a slower pace at once and a faster one gradually.
    const bool first_or_slower = between_ == Clock::duration::max() || took >= between_;
    between_ = first_or_slower ? took : (3 * between_ + took) / 4;
  }

  int Ahead() const {
    if (between_ > soon_) return 0;
    return static_cast<int>(std::min<Clock::rep>(
        kMostAhead, soon_ / std::max<Clock::duration>(between_, std::chrono::microseconds(1))));
  }

 private:
  const Clock::duration soon_;
  Clock::time_point last_;
  Clock::duration between_ = Clock::duration::max();  // between two computed runs
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_RUN_PACE_H_
