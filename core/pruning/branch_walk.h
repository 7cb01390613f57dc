#ifndef BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
#define BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_

#include <algorithm>
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/pruning/thin_set.h"

namespace bccskel {

// A branch with a free end: the points from the end to the first junction.
struct FreeBranch {
  std::vector<LatticePoint> points;      // the end first; without the junction
  std::optional<LatticePoint> junction;  // none: the path leads to another end
};

// The one neighbor in `mask` that is not `previous`. Needs: there is one.
inline LatticePoint NextPoint(LatticePoint p, NeighborMask mask, LatticePoint previous) {
  LatticePoint next = previous;
  ForEachNeighbor(p, mask, [&](LatticePoint q) {
    if (q != previous) next = q;
  });
  return next;
}

// Appends the inner points of the curve that leads from `previous` to `p` and on. Returns the point
// at which the curve stops: an end or a junction.
inline LatticePoint FollowCurve(const ThinSet& set, LatticePoint previous, LatticePoint p,
                                std::vector<LatticePoint>& points) {
  NeighborMask mask = set.NeighborsOf(p);
  while (IsCurvePoint(mask)) {
    points.push_back(p);
    const LatticePoint next = NextPoint(p, mask, previous);
    previous = p;
    p = next;
    mask = set.NeighborsOf(p);
  }
  return p;
}

// ClusterOf() stops at this size: a cavity leaves a whole surface as one cluster, whose far points
// say nothing about the first.
inline constexpr size_t kMostClusterPoints = 64;

// The junction point and those connected to it by points with three or more neighbors.
inline std::vector<LatticePoint> ClusterOf(const ThinSet& set, LatticePoint junction) {
  std::vector<LatticePoint> cluster = {junction};
  for (size_t n = 0; n < cluster.size() && cluster.size() < kMostClusterPoints; ++n) {
    ForEachNeighbor(cluster[n], set.NeighborsOf(cluster[n]), [&](LatticePoint q) {
      if (set.Branches(q) && std::ranges::find(cluster, q) == cluster.end()) {
        cluster.push_back(q);
      }
    });
  }
  return cluster;
}

// Needs: an end point.
inline FreeBranch BranchFrom(const ThinSet& set, LatticePoint end) {
  FreeBranch branch{{end}, std::nullopt};
  const LatticePoint first = NextPoint(end, set.NeighborsOf(end), end);
  const LatticePoint p = FollowCurve(set, end, first, branch.points);
  if (set.IsEnd(p)) {
    branch.points.push_back(p);
  } else {
    branch.junction = p;
  }
  return branch;
}

// A curve that leads away from a fork.
struct Arm {
  LatticePoint fork;
  std::vector<LatticePoint> points;  // from the fork on
  bool is_free = false;              // leads to an end, which is the last of them
};

// The curves that leave a cluster.
inline std::vector<Arm> ArmsOf(const ThinSet& set, std::span<const LatticePoint> cluster) {
  std::vector<Arm> arms;
  for (LatticePoint fork : cluster) {
    ForEachNeighbor(fork, set.NeighborsOf(fork), [&](LatticePoint first) {
      if (set.Branches(first)) return;
      Arm& arm = arms.emplace_back(Arm{fork, {}});
      const LatticePoint last = FollowCurve(set, fork, first, arm.points);
      arm.is_free = set.IsEnd(last);
      if (arm.is_free) arm.points.push_back(last);
    });
  }
  return arms;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BRANCH_WALK_H_
