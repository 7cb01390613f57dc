#ifndef BCCSKEL_CLIENT_CLI_LOCAL_TEAM_H_
#define BCCSKEL_CLIENT_CLI_LOCAL_TEAM_H_

#include <algorithm>
#include <stop_token>
#include <thread>

#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel::cli {

// The threads of this machine that a command may use, and the context that hands them on.
class LocalTeam {
 public:
  // `threads` 0 takes as many as the machine runs at once.
  LocalTeam(int threads, const std::stop_token& stop)
      : team_(threads > 0 ? threads
                          : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {
    context_.team = &team_;
    context_.stop = stop;
  }

  exec::Context& context() { return context_; }

 private:
  exec::WorkerTeam team_;
  exec::Context context_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_LOCAL_TEAM_H_
