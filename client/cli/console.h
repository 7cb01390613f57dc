#ifndef BCCSKEL_CLIENT_CLI_CONSOLE_H_
#define BCCSKEL_CLIENT_CLI_CONSOLE_H_

#include <algorithm>
#include <atomic>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>
#include <thread>

#include "absl/status/status.h"
#include "core/exec/context.h"
#include "core/exec/worker_team.h"

namespace bccskel::cli {

struct ServerArguments;

enum class SummaryStyle { kText, kJson };
enum class ProgressStyle {
  kAuto,    // a bar on a terminal, nothing elsewhere
  kAlways,  // a bar on a terminal, a line per shell elsewhere
  kNever,
};

// How the command line ends; part of its public contract (see bccskel.1 and --help).
enum class ExitCode : int {
  kOk = 0,
  kUsage = 2,        // the command line itself is wrong
  kBadInput = 3,     // the input cannot be read or is invalid
  kUnavailable = 4,  // no server, or the server went away
  kStopped = 5,      // the deadline passed, or the server cancelled the job
  kInternal = 6,     // a defect: changed topology, a damaged reply, a job that crashes servers
  kTooLarge = 7,     // over a limit of the server or of this machine
  kOutput = 8,       // an output file cannot be written
  kCredentials = 9,  // a token is missing, wrong or lacks the permission
  kInterrupted = 130,
  kTerminated = 143,
};

// The exit code for an error of the input or of a job.
ExitCode ExitCodeOf(const absl::Status& status);

// The output of commands. Results go to standard output, everything else to standard error, after
// the name of the program.

// "bccskel" unless set. Needs: `name` outlives all commands; called before any command runs.
void SetProgramName(std::string_view name);
std::string_view ProgramName();

void Warn(std::string_view message);

// Prints the error and the hint, if any, and returns the exit code. Takes CANCELLED as an
// interruption; only FailOnServer() takes it as a cancelled job.
ExitCode Fail(const absl::Status& error, std::string_view hint = "");
ExitCode FailWith(ExitCode code, const absl::Status& error);

// For failures between the user and a server, which the message names. A specific hint suggests
// what may be wrong with the connection. `local` says what computes without one, if anything does.
ExitCode FailOnServer(const ServerArguments& server, const absl::Status& error,
                      std::string_view local = "");

// Prints a command's result. kOutput if standard output cannot be written.
ExitCode Print(std::string_view text);

// Turns Ctrl-C (SIGINT) and SIGTERM into a stop request; the second signal ends the program at
// once. A thread reads signals, so nothing runs inside a signal handler.
// Needs: created before any other thread, so that all threads inherit the blocked signals.
class Interrupt {
 public:
  Interrupt();
  ~Interrupt();
  Interrupt(const Interrupt&) = delete;
  Interrupt& operator=(const Interrupt&) = delete;

  std::stop_token token() const { return source_.get_token(); }
  // 130 or 143 after a signal.
  std::optional<ExitCode> exit_code() const;

 private:
  void Watch();

  std::stop_source source_;
  std::atomic<int> signal_{0};
  int signals_ = -1;  // a signalfd
  int leave_ = -1;    // an eventfd: wakes the thread when the program ends
  std::thread thread_;
};

// The threads of this machine that a command may use, and a context with them.
class LocalTeam {
 public:
  // `threads` 0 means one per hardware thread.
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

#endif  // BCCSKEL_CLIENT_CLI_CONSOLE_H_
