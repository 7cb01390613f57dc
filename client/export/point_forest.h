#ifndef BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
#define BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// The skeleton's points, each once, as one tree per component: what formats without loops need.
struct PointForest {
  // A parent comes before its children, and a branch is in one piece.
  std::vector<SkeletonPoint> points;
  // Position of the parent in `points`; nothing for a root.
  std::vector<std::optional<size_t>> parents;
  size_t trees = 0;
  // Loops of the graph that a tree cannot show.
  size_t loops_cut = 0;
};

// The root of a component is the first of `roots` in it, or else its deepest point, on ties the
// smallest. Every point hangs on the shortest way to its root, so a loop is cut at the step
// farthest from the root and no point is lost.
// Needs: `roots` are nodes' points.
PointForest PointForestOf(const SkeletonGraph& graph, std::span<const LatticePoint> roots = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_POINT_FOREST_H_
