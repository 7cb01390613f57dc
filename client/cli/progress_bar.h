#ifndef BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_
#define BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_

#include <chrono>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <thread>

#include "client/cli/console.h"
#include "core/exec/context.h"

namespace bccskel::cli {

// "[######----] shell 6/10  123,456 points removed, 7,890 left  1.2 s", without a line end.
std::string ProgressLine(const exec::ShellProgress& progress,
                         std::chrono::duration<double> elapsed);

// Shows on standard error what a command does. On a terminal one line changes at least once a
// second: the shells of a running job, or the phase before or after them and its time.
// Threads: the methods and callbacks from one thread at a time. One at a time in a process.
class ProgressBar {
 public:
  explicit ProgressBar(ProgressStyle style);
  ~ProgressBar();  // leaves a clean line
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  // Begins a phase, such as "reading a.off", where only the last part of the path is shown. It ends
  // with the next one, a callback or a message. Terminals show it after half a second, logs at
  // once.
  void Begin(std::string_view phase, std::string_view path = {}) const;

  // Begin the phase before the first call, and return callbacks for after each shell, or for the
  // number of finished labels; empty if nothing is to be shown. After the last shell another phase
  // begins.
  std::function<void(const exec::ShellProgress&)> Callback(const std::string& phase);
  std::function<void(uint64_t done, uint64_t total)> LabelsCallback(const std::string& phase);

 private:
  enum class Form { kNothing, kBar, kLines };
  static Form FormOf(ProgressStyle style);
  void Show(const std::string& line, bool last) const;

  Form form_;
  std::jthread ticker_;  // redraws the line
};

// Ends the line that a bar shows, so that a message can follow.
void EndProgressLine();

}  // namespace bccskel::cli

#endif  // BCCSKEL_CLIENT_CLI_PROGRESS_BAR_H_
