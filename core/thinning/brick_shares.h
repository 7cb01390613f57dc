#ifndef BCCSKEL_CORE_THINNING_BRICK_SHARES_H_
#define BCCSKEL_CORE_THINNING_BRICK_SHARES_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/shells/shells.h"
#include "core/thinning/work_list.h"
#include "core/volume/brick.h"

namespace bccskel {

// Which worker owns which bricks: a contiguous range each, possibly empty, in the order of the
// workers. Only bricks that hold points of the shells being thinned are work, and these gather
// toward the middle of an object as shells get deeper, so ranges move with them.
class BrickShares {
 public:
  // Ranges of equal length.
  BrickShares(size_t bricks, int workers);

  exec::Share Of(int worker) const;
  int OwnerOf(BrickIndex brick) const { return owners_[brick / kDirtyGroup]; }
  // By group of kDirtyGroup bricks.
  const uint16_t* owners() const { return owners_.data(); }

  // The steps of moving the ranges before `shell` and the kShellsAtOnce - 1 after it are opened.
  // All workers call the first two, worker 0 the third, and all meet after each.
  void Count(int worker, const Shells& shells, int32_t shell);
  // After Count(): whether it pays to go on, the same on all workers. One of them has clearly more
  // to do than if as many as can have `fewest` bricks shared evenly. Needs: fewest >= 1.
  bool Uneven(size_t fewest) const;
  void Cut(int worker, const Shells& shells, int32_t shell, size_t fewest);
  void Adopt();

  // Worker 0 owns everything.
  void JoinInOne();

 private:
  size_t WorkBefore(size_t worker) const;
  size_t WorkersToUse(size_t fewest) const;

  const size_t bricks_;
  std::vector<size_t> cuts_;  // worker w owns the bricks from cuts_[w] to cuts_[w + 1]
  std::vector<size_t> next_cuts_;
  std::vector<size_t> work_;      // bricks with points of the next shells, by worker
  std::vector<uint16_t> owners_;  // as of owners()
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_BRICK_SHARES_H_
