#ifndef BCCSKEL_CORE_SKELETON_SPANNING_TREES_H_
#define BCCSKEL_CORE_SKELETON_SPANNING_TREES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/skeleton/thin_points.h"

namespace bccskel {

// A path of points, each a neighbor of the one before.
using PointPath = std::vector<PointIndex>;

// Trees of shortest paths, counted in steps, inside connected sets of points. Of two paths of the
// same length the one found first is taken; neighbors are visited in the order of kDirections14.
class SpanningTrees {
 public:
  // Shapes: masks[p] has the neighbors of p that belong to p's set.
  SpanningTrees(const ThinPoints& points, std::span<const NeighborMask> masks)
      : points_(points), masks_(masks), parents_(points.size()), depths_(points.size()) {}

  // Grows the tree of root's set. Needs: no tree has grown there.
  void GrowFrom(PointIndex root, StopPoll& poll);

  // Steps from the root. Needs: the point's tree has grown.
  uint32_t Depth(PointIndex p) const { return depths_[p] - 1; }
  PointIndex Parent(PointIndex p) const { return parents_[p]; }  // the root's is the root
  // From the root to p, both included.
  PointPath PathTo(PointIndex p) const;

 private:
  const ThinPoints& points_;
  const std::span<const NeighborMask> masks_;
  std::vector<PointIndex> parents_;
  std::vector<uint32_t> depths_;  // depth + 1; 0: not reached by any tree
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_SPANNING_TREES_H_
