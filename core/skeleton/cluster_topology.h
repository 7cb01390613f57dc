#ifndef BCCSKEL_CORE_SKELETON_CLUSTER_TOPOLOGY_H_
#define BCCSKEL_CORE_SKELETON_CLUSTER_TOPOLOGY_H_

#include <cstdint>
#include <span>

#include "core/exec/stop_poll.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

struct ClusterTopology {
  uint32_t loops = 0;
  uint32_t cavities = 0;

  friend bool operator==(const ClusterTopology&, const ClusterTopology&) = default;
};

// Counts loops and cavities of a connected set of points in isolation.
// Shapes: `cluster` holds the set; masks[p] has the neighbors of each of its points that belong to
//         the set; `seen` is scratch memory of the same size, zero for unvisited points.
// Cost:   proportional to the number of points.
ClusterTopology MeasureCluster(const ThinPoints& points, std::span<const PointIndex> cluster,
                               std::span<const NeighborMask> masks, std::span<NeighborMask> seen,
                               StopPoll& poll);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CLUSTER_TOPOLOGY_H_
