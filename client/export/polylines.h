#ifndef BCCSKEL_CLIENT_EXPORT_POLYLINES_H_
#define BCCSKEL_CLIENT_EXPORT_POLYLINES_H_

#include <cstddef>
#include <stop_token>
#include <vector>

#include "core/skeleton/skeleton_graph.h"

namespace bccskel::exporting {

// A graph as numbered points and polylines over them, the model of VTP and OBJ.
struct Polylines {
  // The nodes in order, then the inner points of every edge, then the points of sheets.
  std::vector<SkeletonPoint> points;
  std::vector<WorldPoint> places;  // of the points, moved onto smooth curves
  // One per edge, in order: indices into `points`, at least two.
  std::vector<std::vector<size_t>> lines;
  // Isolated nodes, then all points of sheets: indices into `points`.
  std::vector<size_t> lone_points;
  size_t first_of_sheets = 0;  // index into `points`
};

// After a stop request it returns early, with a part of them.
Polylines PolylinesOf(const SkeletonGraph& graph, const std::stop_token& stop = {});

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_POLYLINES_H_
