#ifndef BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
#define BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stop_token>
#include <vector>

#include "client/export/sampled_curve.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/tree_order.h"

namespace bccskel::exporting {

// The graph as one tree per component, for formats without loops. World coordinates and units.
struct PointForest {
  struct Point {
    WorldPoint at;
    double radius;
    std::optional<size_t> parent;  // index into `points`; none for a root
    std::optional<uint32_t> node;  // of the graph; none inside an edge
  };
  // Parents precede their children, and the points of a branch are consecutive. Each node is one
  // point.
  std::vector<Point> points;
  size_t trees = 0;
  // Loops of the graph that had to be cut.
  size_t loops_cut = 0;
};

// Cuts an edge that closes a loop at the step farthest from its root, so that no point is lost.
// After a stop request it returns early, with a part of the points.
// Needs: `order` belongs to this graph; the step is not negative.
PointForest PointForestOf(const SkeletonGraph& graph, const TreeOrder& order,
                          const CurveSampling& sampling = {}, const std::stop_token& stop = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
