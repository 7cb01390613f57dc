#include "client/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "client/export/picture/caption.h"

namespace bccskel::cli {
namespace {

constexpr int64_t kBarWidth = 28;
// A terminal is redrawn no more often than the eye sees.
constexpr std::chrono::milliseconds kRedrawPause(50);

}  // namespace

std::string ProgressLine(const exec::ShellProgress& progress,
                         std::chrono::duration<double> elapsed) {
  const int64_t last = std::max(progress.last_shell, 1);
  const int64_t filled = std::clamp<int64_t>(kBarWidth * progress.shell / last, 0, kBarWidth);
  std::string seconds(32, '\0');
  seconds.resize(static_cast<size_t>(
      std::snprintf(seconds.data(), seconds.size(), "%.1f s", elapsed.count())));
  return '[' + std::string(static_cast<size_t>(filled), '#') +
         std::string(static_cast<size_t>(kBarWidth - filled), '-') + "] shell " +
         std::to_string(progress.shell) + '/' + std::to_string(progress.last_shell) + "  " +
         exporting::GroupedDigits(progress.removed) + " points removed, " +
         exporting::GroupedDigits(progress.remaining) + " left  " + seconds;
}

ProgressBar::Form ProgressBar::FormOf(ProgressStyle style) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  if (style == ProgressStyle::kNever) return Form::kNothing;
  if (terminal) return Form::kBar;
  return style == ProgressStyle::kAlways ? Form::kLines : Form::kNothing;
}

ProgressBar::ProgressBar(ProgressStyle style) : form_(FormOf(style)) {}

ProgressBar::~ProgressBar() {
  if (line_open_) std::fputc('\n', stderr);
}

std::function<void(const exec::ShellProgress&)> ProgressBar::Callback() {
  if (form_ == Form::kNothing) return {};
  return [this](const exec::ShellProgress& progress) { Show(progress); };
}

void ProgressBar::Show(const exec::ShellProgress& progress) {
  const Clock::time_point now = Clock::now();
  const std::string line = ProgressLine(progress, now - start_);
  if (form_ == Form::kLines) {
    std::fprintf(stderr, "%s\n", line.c_str());
    return;
  }
  if (now - shown_ < kRedrawPause && progress.shell < progress.last_shell) return;
  std::fprintf(stderr, "\r%s\033[K", line.c_str());  // and clears what a longer line left
  std::fflush(stderr);
  shown_ = now;
  line_open_ = true;
}

}  // namespace bccskel::cli
