#ifndef BCCSKEL_CORE_EXEC_STOP_POLL_H_
#define BCCSKEL_CORE_EXEC_STOP_POLL_H_

#include <cstdint>

#include "core/exec/context.h"

namespace bccskel {

// Asks a context now and then whether to stop: once in 1024 calls, which is well within 20 ms of
// steps over single points. Once true, always true.
class StopPoll {
 public:
  explicit StopPoll(const exec::Context& context) : context_(context) {}

  bool Stopped() { return ++calls_ % 1024 == 0 ? StoppedNow() : stopped_; }
  // Asks at once: for steps of many points.
  bool StoppedNow() {
    stopped_ = stopped_ || context_.ShouldStop();
    return stopped_;
  }

 private:
  const exec::Context& context_;
  uint64_t calls_ = 0;
  bool stopped_ = false;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXEC_STOP_POLL_H_
