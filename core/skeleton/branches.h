#ifndef BCCSKEL_CORE_SKELETON_BRANCHES_H_
#define BCCSKEL_CORE_SKELETON_BRANCHES_H_

#include <vector>

#include "core/exec/stop_poll.h"
#include "core/skeleton/clusters.h"
#include "core/skeleton/spanning_trees.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// A chain of points from a point of one cluster to a point of another or the same, with curve
// points or bends between them.
struct Branch {
  ClusterIndex source = 0;
  ClusterIndex target = 0;
  PointPath points;
};

struct Branches {
  std::vector<Branch> between;    // between clusters that are not bends
  std::vector<PointPath> closed;  // curves without junction; first and last point are the same
};

// All curves of the volume, in no particular order or direction.
Branches FollowBranches(const ThinPoints& points, const Clusters& clusters, StopPoll& poll);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_BRANCHES_H_
