#ifndef BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
#define BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_

#include <optional>
#include <vector>

#include "core/pruning/thin_set.h"

namespace bccskel {

// The points from an end along curve points.
struct FreeBranch {
  std::vector<LatticePoint> points;      // the end first; without the junction
  std::optional<LatticePoint> junction;  // none: the walk came to the other end
};

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
  while (set.Degree(p) == 2) {
    branch.points.push_back(p);
    const LatticePoint next = NextPoint(p, set.NeighborsOf(p), previous);
    previous = p;
    p = next;
  }
  if (set.Degree(p) > 2) {
    branch.junction = p;
  } else {
    branch.points.push_back(p);
  }
  return branch;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
