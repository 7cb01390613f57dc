#include "core/skeleton/spanning_trees.h"

#include <algorithm>

namespace bccskel {

void SpanningTrees::GrowFrom(PointIndex root, StopPoll& poll) {
  PointPath reached = {root};
  parents_[root] = root;
  depths_[root] = 1;
  for (size_t n = 0; n < reached.size() && !poll.Stopped(); ++n) {
    const PointIndex p = reached[n];
    ForEachDirection(masks_[p], [&](Direction d) {
      const PointIndex q = points_.Neighbor(p, d);
      if (depths_[q] != 0) return;
      parents_[q] = p;
      depths_[q] = depths_[p] + 1;
      reached.push_back(q);
    });
  }
}

PointPath SpanningTrees::PathTo(PointIndex p) const {
  PointPath path = {p};
  while (parents_[path.back()] != path.back()) path.push_back(parents_[path.back()]);
  std::ranges::reverse(path);
  return path;
}

}  // namespace bccskel
