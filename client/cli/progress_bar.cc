#include "client/cli/progress_bar.h"

#include <unistd.h>

#include <algorithm>
#include <condition_variable>
#include <cstdio>
#include <mutex>

#include "absl/strings/str_format.h"
#include "client/export/picture/caption.h"

namespace bccskel::cli {
namespace {

using ProgressClock = std::chrono::steady_clock;

constexpr uint64_t kBarWidth = 28;
// Redraws are no more frequent than the eye can see.
constexpr std::chrono::milliseconds kRedrawPause(50);
constexpr std::chrono::milliseconds kTick(250);
constexpr std::chrono::milliseconds kLongestPause(500);

// What the terminal's last line is for.
struct ShownLine {
  std::mutex mutex;
  std::string text;                 // without its time; empty: nobody draws
  bool stays = false;               // when the next line begins: true for bars, false for phases
  bool is_open = false;             // drawn and not ended
  ProgressClock::time_point start;  // of the time that it shows
  ProgressClock::time_point drawn;
};
ShownLine shown_line;

std::string SecondsText(std::chrono::duration<double> elapsed) {
  return absl::StrFormat("%.1f s", elapsed.count());
}

// "[####----] WHAT N/TOTAL  MORE"
std::string BarText(const char* what, uint64_t done, uint64_t total, const std::string& more) {
  const uint64_t filled = kBarWidth * std::min(done, total) / std::max<uint64_t>(total, 1);
  return '[' + std::string(filled, '#') + std::string(kBarWidth - filled, '-') + "] " + what + ' ' +
         std::to_string(done) + '/' + std::to_string(total) + "  " + more;
}

// Short enough for one line of a terminal.
std::string PhaseText(std::string_view phase, std::string_view path) {
  constexpr size_t kMostOfName = 50;
  while (path.ends_with('/')) path.remove_suffix(1);
  path.remove_prefix(path.rfind('/') + 1);  // npos + 1 is 0
  std::string text(phase);
  if (!path.empty()) text += ' ' + std::string(path.substr(0, kMostOfName));
  return text + (path.size() > kMostOfName ? "..." : "");
}

std::string ShellText(const exec::ShellProgress& progress) {
  return BarText("shell", static_cast<uint64_t>(std::max(progress.shell, 0)),
                 static_cast<uint64_t>(std::max(progress.last_shell, 0)),
                 exporting::GroupedDigits(progress.removed) + " points removed, " +
                     exporting::GroupedDigits(progress.remaining) + " left  ");
}

// Needs: the line's mutex, as the next two.
void DrawLine(ShownLine& line) {
  const ProgressClock::time_point now = ProgressClock::now();
  std::fprintf(stderr, "\r%s%s\033[K", line.text.c_str(), SecondsText(now - line.start).c_str());
  std::fflush(stderr);
  line.drawn = now;
  line.is_open = true;
}

void EndLine(ShownLine& line) {
  if (line.is_open) std::fputs(line.stays ? "\n" : "\r\033[K", stderr);
  line.is_open = false;
  line.text.clear();
}

void RedrawLine(const std::stop_token& stop) {
  std::condition_variable_any never;
  std::unique_lock lock(shown_line.mutex);
  while (!stop.stop_requested()) {
    never.wait_for(lock, stop, kTick, [] { return false; });
    if (!shown_line.text.empty() && ProgressClock::now() - shown_line.drawn >= kLongestPause) {
      DrawLine(shown_line);
    }
  }
}

}  // namespace

std::string ProgressLine(const exec::ShellProgress& progress,
                         std::chrono::duration<double> elapsed) {
  return ShellText(progress) + SecondsText(elapsed);
}

ProgressBar::Form ProgressBar::FormOf(ProgressStyle style) {
  const bool terminal = ::isatty(STDERR_FILENO) == 1;
  if (style == ProgressStyle::kNever) return Form::kNothing;
  if (terminal) return Form::kBar;
  return style == ProgressStyle::kAlways ? Form::kLines : Form::kNothing;
}

ProgressBar::ProgressBar(ProgressStyle style) : form_(FormOf(style)) {
  if (form_ == Form::kBar)
    ticker_ = std::jthread([](const std::stop_token& stop) { RedrawLine(stop); });
}

ProgressBar::~ProgressBar() { EndProgressLine(); }

void ProgressBar::Begin(std::string_view phase, std::string_view path) const {
  const std::lock_guard lock(shown_line.mutex);
  EndLine(shown_line);
  if (form_ == Form::kBar) shown_line.text = PhaseText(phase, path) + "  ";
  if (form_ == Form::kLines) std::fprintf(stderr, "%s\n", PhaseText(phase, path).c_str());
  shown_line.stays = false;
  shown_line.start = shown_line.drawn = ProgressClock::now();
}

std::function<void(const exec::ShellProgress&)> ProgressBar::Callback(const std::string& phase) {
  if (form_ == Form::kNothing) return {};
  Begin(phase);
  return [this](const exec::ShellProgress& progress) {
    const bool last = progress.shell >= progress.last_shell;
    Show(ShellText(progress), last);
    if (last) Begin("pruning, tracing curves and checking the topology");
  };
}

std::function<void(uint64_t, uint64_t)> ProgressBar::LabelsCallback(const std::string& phase) {
  if (form_ == Form::kNothing) return {};
  Begin(phase);
  return [this](uint64_t done, uint64_t total) {
    Show(BarText("label", done, total, ""), done >= total);
  };
}

void ProgressBar::Show(const std::string& line, bool last) const {
  ShownLine& shown = shown_line;
  const std::lock_guard lock(shown.mutex);
  if (form_ == Form::kLines) {
    std::fprintf(stderr, "%s%s\n", line.c_str(),
                 SecondsText(ProgressClock::now() - shown.start).c_str());
    return;
  }
  shown.text = line;
  shown.stays = true;
  if (ProgressClock::now() - shown.drawn >= kRedrawPause || last) DrawLine(shown);
}

void EndProgressLine() {
  const std::lock_guard lock(shown_line.mutex);
  EndLine(shown_line);
}

}  // namespace bccskel::cli
