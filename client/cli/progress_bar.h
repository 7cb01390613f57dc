#ifndef BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_
#define BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_

#include <chrono>
#include <functional>
#include <string>

#include "client/cli/arguments.h"
#include "core/exec/context.h"

namespace bccskel::cli {

// "[######----] shell 6/10  123,456 points removed, 7,890 left  1.2 s", without a line end.
std::string ProgressLine(const exec::ShellProgress& progress,
                         std::chrono::duration<double> elapsed);

// Shows the shells of a running job on standard error.
// Threads: Show() from one thread at a time.
class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style);
  ~ProgressBar();  // leaves a clean line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // What a job calls after each shell; empty when nothing is to be shown.
  std::function<void(const exec::ShellProgress&)> Callback();

 private:
  enum class Form { kNothing, kBar, kLines };
  static Form FormOf(ProgressStyle style);
  void Show(const exec::ShellProgress& progress);

  using Clock = std::chrono::steady_clock;
  Form form_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point shown_;
  bool line_open_ = false;
};

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_
