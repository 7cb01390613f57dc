#ifndef BCCSKEL_CORE_EXEC_STOP_POLL_H_
#define BCCSKEL_CORE_EXEC_STOP_POLL_H_

#include <cstdint>

#include "core/exec/context.h"

namespace bccskel {

// Asks a context once in 1024 steps whether to stop; for loops over single points, so well within
// 20 ms. Once true, it stays true.
class StopPoll {
 public:
  explicit StopPoll(const exec::Context& context) : context_(context) {}

  // `steps`: how many points the work since the last call is worth.
  bool Stopped(uint64_t steps = 1) {
    since_ += steps;
    return since_ >= 1024 ? StoppedNow() : stopped_;
  }
  // Asks in each call: for steps over many points.
  bool StoppedNow() {
    since_ = 0;
    stopped_ = stopped_ || context_.ShouldStop();
    return stopped_;
  }

 private:
  const exec::Context& context_;
  uint64_t since_ = 0;  // steps since the context was asked
  bool stopped_ = false;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXEC_STOP_POLL_H_
