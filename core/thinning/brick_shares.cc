#include "core/thinning/brick_shares.h"

#include <algorithm>
#include <numeric>
#include <span>

#include "core/thinning/open_shell.h"

namespace bccskel {
namespace {

bool HasWork(const Shells& shells, size_t brick, int32_t shell) {
  const Shells::Range range = shells.RangeOf(static_cast<BrickIndex>(brick));
  return range.first < shell + kShellsAtOnce && range.last >= shell;
}

// Full groups, and one more with room for the padding brick.
size_t GroupsOf(size_t bricks) { return bricks / kDirtyGroup + 1; }

}  // namespace

BrickShares::BrickShares(size_t bricks, int workers)
    : bricks_(bricks),
      next_cuts_(static_cast<size_t>(workers) + 1),
      work_(static_cast<size_t>(workers)),
      owners_(GroupsOf(bricks)) {
  for (int worker = 0; worker < workers; ++worker) {
    const exec::Share groups = exec::ShareOf(owners_.size(), worker, workers);
    next_cuts_[static_cast<size_t>(worker) + 1] = std::min(groups.end * kDirtyGroup, bricks);
  }
  Adopt();
}

exec::Share BrickShares::Of(int worker) const {
  const auto w = static_cast<size_t>(worker);
  return {cuts_[w], cuts_[w + 1]};
}

void BrickShares::Count(int worker, const Shells& shells, int32_t shell) {
  const auto [begin, end] = Of(worker);
  size_t work = 0;
  for (size_t n = begin; n < end; ++n) work += HasWork(shells, n, shell) ? 1 : 0;
  work_[static_cast<size_t>(worker)] = work;
}

// The work of all workers before this one.
size_t BrickShares::WorkBefore(size_t worker) const {
  return std::accumulate(work_.begin(), work_.begin() + static_cast<std::ptrdiff_t>(worker),
                         size_t{0});
}

size_t BrickShares::WorkersToUse(size_t fewest) const {
  return std::clamp<size_t>(WorkBefore(work_.size()) / fewest, 1, work_.size());
}

bool BrickShares::Uneven(size_t fewest) const {
  const size_t even = WorkBefore(work_.size()) / WorkersToUse(fewest);
  return std::ranges::max(work_) > even + even / 3 + kDirtyGroup;
}

void BrickShares::Cut(int worker, const Shells& shells, int32_t shell, size_t fewest) {
  const size_t use = WorkersToUse(fewest);
  if (worker == 0) std::ranges::fill(std::span(next_cuts_).subspan(use), bricks_);
  const auto w = static_cast<size_t>(worker);
  const size_t total = WorkBefore(work_.size());
  size_t before = WorkBefore(w), brick = Of(worker).begin;
  const size_t after = before + work_[w];
  for (size_t k = 1; k < use; ++k) {
    const size_t target = total * k / use;
    if (target < before || target >= after) continue;
    for (; before < target || !HasWork(shells, brick, shell); ++brick) {
      before += HasWork(shells, brick, shell) ? 1 : 0;
    }
    const size_t groups = (brick + kDirtyGroup - 1) / kDirtyGroup;
    next_cuts_[k] = std::min(groups * kDirtyGroup, bricks_);
  }
}

void BrickShares::Adopt() {
  cuts_ = next_cuts_;
  for (size_t worker = 0; worker < work_.size(); ++worker) {
    for (size_t n = cuts_[worker]; n < cuts_[worker + 1]; n += kDirtyGroup) {
      owners_[n / kDirtyGroup] = static_cast<uint16_t>(worker);
    }
  }
}

void BrickShares::JoinInOne() {
  std::ranges::fill(std::span(next_cuts_).subspan(1), bricks_);
  Adopt();
}

}  // namespace bccskel
