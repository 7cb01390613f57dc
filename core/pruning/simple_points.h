#ifndef BCCSKEL_CORE_PRUNING_SIMPLE_POINTS_H_
#define BCCSKEL_CORE_PRUNING_SIMPLE_POINTS_H_

#include <set>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Removes simple points that are not ends, shallow ones first, equally deep ones in lattice order:
// first those in `from`, then their neighbors, and so on. Points of `keep` stay.
// Returns: the removed points in order.
std::vector<LatticePoint> RemoveSimplePoints(ThinSet& set, const std::set<LatticePoint>& from,
                                             const PointSet& keep, StopPoll* poll = nullptr);

// The same for the whole set. Both leave some points if `poll` requests a stop.
void RemoveSimplePoints(ThinSet& set, const PointSet& keep, StopPoll& poll);

struct RemovedBranch {
  std::vector<LatticePoint> points;  // those of the branch and some at the junction
  std::set<LatticePoint> around;     // the junction, and what was beside it and the latter
};

// Removes a branch and the points at its junction that have become simple.
// Needs: the branch has a junction.
RemovedBranch RemoveBranch(ThinSet& set, const FreeBranch& branch, const PointSet& keep);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SIMPLE_POINTS_H_
