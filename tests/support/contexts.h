#ifndef BCCSKEL_TESTS_SUPPORT_CONTEXTS_H_
#define BCCSKEL_TESTS_SUPPORT_CONTEXTS_H_

#include <chrono>
#include <stop_token>

#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel::test {

// With its own workers, among which even the smallest work is divided.
struct TeamContext : exec::Context {
  explicit TeamContext(int threads) : workers(threads) {
    team = &workers;
    min_bricks_per_worker = 1;
  }

  exec::WorkerTeam workers;
};

// Of a caller who has cancelled.
inline exec::Context Stopped() {
  std::stop_source source;
  source.request_stop();
  exec::Context context;
  context.stop = source.get_token();
  return context;
}

// Of a caller whose time is over.
inline exec::Context Late() {
  exec::Context context;
  context.deadline = exec::Context::Clock::now() - std::chrono::seconds(1);
  return context;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_CONTEXTS_H_
