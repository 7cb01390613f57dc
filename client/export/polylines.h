#ifndef BCCSKEL_CLIENT_EXPORT_POLYLINES_H_
#define BCCSKEL_CLIENT_EXPORT_POLYLINES_H_

#include <cstddef>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// A graph as numbered points and polylines over them, the model of VTP and OBJ.
struct Polylines {
  // First the nodes, in their order, then the inner points of every edge, then those of sheets.
  std::vector<SkeletonPoint> points;
  // One per edge, in the order of the edges: positions in `points`, at least two.
  std::vector<std::vector<size_t>> lines;
  // Nodes that no edge touches, then all points of sheets: positions in `points`.
  std::vector<size_t> lone_points;
  size_t first_of_sheets = 0;  // in `points`
};

Polylines PolylinesOf(const SkeletonGraph& graph);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_POLYLINES_H_
