#ifndef BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
#define BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "client/export/sampled_curve.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

// The graph as one tree per component: what formats without loops need. World coordinates and
// units.
struct PointForest {
  struct Point {
    WorldPoint at;
    double radius;
    std::optional<size_t> parent;  // position in `points`; nothing for a root
    std::optional<uint32_t> node;  // of the graph; nothing inside an edge
  };
  // A parent comes before its children, and a branch is in one piece. Each node is one point.
  std::vector<Point> points;
  size_t trees = 0;
  // Loops of the graph that a tree cannot show.
  size_t loops_cut = 0;
};

// An edge that closes a loop is cut at the step farthest from its root, so no point is lost.
// Needs: the order is of this graph; a step is not negative.
PointForest PointForestOf(const SkeletonGraph& graph, const TreeOrder& order,
                          const CurveSampling& sampling = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
