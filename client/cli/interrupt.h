#ifndef BCCSKEL_CLIENT_CLI_INTERRUPT_H_
#define BCCSKEL_CLIENT_CLI_INTERRUPT_H_

#include <atomic>
#include <optional>
#include <stop_token>
#include <thread>

#include "client/cli/exit_code.h"

namespace bccskel::cli {

// Turns Ctrl-C (SIGINT) and SIGTERM into a stop request; the second one ends the program at once.
// Signals are read by a thread, so nothing runs inside a signal handler.
// Needs: made before any other thread, so that all threads inherit the blocked signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  // 130 or 143 once a signal came.
  std::optional<ExitCode> exit_code() const;

 private:
  void Watch();

  std::stop_source source_;
  std::atomic<int> signal_{0};
  int signals_ = -1;  // a signalfd
  int leave_ = -1;    // an eventfd: wakes the thread when the program ends
  std::thread thread_;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_INTERRUPT_H_
