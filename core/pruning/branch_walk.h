#ifndef BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
#define BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_

#include <bit>
#include <optional>
#include <vector>

#include "core/pruning/thin_set.h"

namespace bccskel {

// A branch with a free end: the points from the end to the first junction.
struct FreeBranch {
  std::vector<LatticePoint> points;      // the end first; without the junction
  std::optional<LatticePoint> junction;  // none: the path leads to another end
};

// Whether exactly two neighbors are set, as for the inner points of a curve.
inline bool IsPair(NeighborMask mask) {
  return std::has_single_bit(static_cast<NeighborMask>(mask & (mask - 1)));
}

// The one neighbor in `mask` that is not `previous`. Needs: there is one.
inline LatticePoint NextPoint(LatticePoint p, NeighborMask mask, LatticePoint previous) {
  LatticePoint next = previous;
  ForEachNeighbor(p, mask, [&](LatticePoint q) {
    if (q != previous) next = q;
  });
  return next;
}

// Needs: an end point.
inline FreeBranch BranchFrom(const ThinSet& set, LatticePoint end) {
  FreeBranch branch{{end}, std::nullopt};
  LatticePoint previous = end;
  LatticePoint p = NextPoint(end, set.NeighborsOf(end), end);
  NeighborMask mask = set.NeighborsOf(p);
  while (IsPair(mask)) {
    branch.points.push_back(p);
    const LatticePoint next = NextPoint(p, mask, previous);
    previous = p;
    p = next;
    mask = set.NeighborsOf(p);
  }
  if (std::has_single_bit(mask)) {
    branch.points.push_back(p);
  } else {
    branch.junction = p;
  }
  return branch;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
