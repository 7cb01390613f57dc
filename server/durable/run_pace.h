#ifndef BCCSKEL_SERVER_DURABLE_RUN_PACE_H_
#define BCCSKEL_SERVER_DURABLE_RUN_PACE_H_

#include <algorithm>
#include <chrono>

namespace bccskel::server {

// Says how many runs to begin before there is a place for them. Claiming a job and reading its
// volume wait for the disk, and so does storing its result: meanwhile others compute. What is
// claimed cannot be begun elsewhere, so it is no more than what is likely to have its turn soon.
// Threads: one at a time; time is what its callers say.
class RunPace {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr int kMostAhead = 8;

  explicit RunPace(std::chrono::milliseconds soon = std::chrono::milliseconds(50)) : soon_(soon) {}

  // A run that was given its volume then has been computed now.
  void Computed(Clock::time_point fed, Clock::time_point now) {
    const Clock::duration took = now - std::max(fed, last_);
    last_ = now;
    // Slower at once, faster little by little.
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
  Clock::duration between_ = Clock::duration::max();  // two that were computed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_RUN_PACE_H_
