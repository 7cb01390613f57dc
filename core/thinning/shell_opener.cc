#include "core/thinning/shell_opener.h"

#include <algorithm>
#include <span>

namespace bccskel {

void ShellOpener::Begin(const Shells& shells, exec::Share bricks, int32_t from) {
  shells_ = &shells;
  by_first_shell_.clear();
  reached_ = 0;
  opening_.clear();
  cut_from_ = kNone;
  for (size_t n = bricks.begin; n < bricks.end; ++n) {
    const Shells::Range range = shells.RangeOf(static_cast<BrickIndex>(n));
    if (range.last < from) continue;
    (range.first < from ? opening_ : by_first_shell_).push_back(static_cast<BrickIndex>(n));
  }
  SortByFirstShell();
}

void ShellOpener::SortByFirstShell() {
  std::ranges::stable_sort(by_first_shell_, {},
                           [this](BrickIndex n) { return shells_->RangeOf(n).first; });
}

uint64_t ShellOpener::Open(const OpeningView& view, int32_t shell) {
  const int32_t within = shell % kShellsAtOnce;
  if (cut_from_ != shell - within) CutFrom(shell - within);
  return OpenShell(view, opening_, points_.data() + static_cast<size_t>(within) * opening_.size());
}

void ShellOpener::CutFrom(int32_t first) {
  std::erase_if(opening_, [&](BrickIndex n) { return shells_->RangeOf(n).last < first; });
  while (reached_ < by_first_shell_.size() &&
         shells_->RangeOf(by_first_shell_[reached_]).first < first + kShellsAtOnce) {
    opening_.push_back(by_first_shell_[reached_++]);
  }
  cut_from_ = first;
  const size_t room = static_cast<size_t>(kShellsAtOnce) * opening_.size();
  if (points_.capacity() < room) points_ = {};  // growing would hold both blocks for a while
  points_.resize(room);
  CutShells(shells_->planes(), first, opening_, points_.data());
  ClearOtherShells();
}

// Planes store shells modulo 64. Where a brick has nearly as many shells, a group of them may also
// match other shells of the brick.
void ShellOpener::ClearOtherShells() {
  for (size_t at = 0; at < opening_.size(); ++at) {
    const Shells::Range range = shells_->RangeOf(opening_[at]);
    if (range.last - range.first <= (1 << kShellPlanes) - kShellsAtOnce) continue;
    for (int32_t k = 0; k < kShellsAtOnce; ++k) {
      const int32_t shell = cut_from_ + k;
      if (shell >= range.first && shell <= range.last) continue;
      points_[static_cast<size_t>(k) * opening_.size() + at] = BrickBits();
    }
  }
}

void ShellOpener::TakeOver(ShellOpener& other) {
  const auto not_reached = std::span(other.by_first_shell_).subspan(other.reached_);
  by_first_shell_.insert(by_first_shell_.end(), not_reached.begin(), not_reached.end());
  opening_.insert(opening_.end(), other.opening_.begin(), other.opening_.end());
  SortByFirstShell();
  cut_from_ = kNone;
  other = {};
}

}  // namespace bccskel
