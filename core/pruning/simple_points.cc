#include "core/pruning/simple_points.h"

#include <utility>

#include "core/topology/neighborhood.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {

std::vector<LatticePoint> RemoveSimplePoints(ThinSet& set, const std::set<LatticePoint>& from,
                                             const PointSet& keep) {
  std::vector<LatticePoint> removed;
  std::set<std::pair<float, LatticePoint>> turns;
  const auto add = [&](LatticePoint p) { turns.emplace(set.RadiusOf(p), p); };
  for (LatticePoint p : from) add(p);
  while (!turns.empty()) {
    const LatticePoint p = turns.begin()->second;
    turns.erase(turns.begin());
    const NeighborMask neighbors = set.NeighborsOf(p);
    if (!IsSimpleNonEnd(neighbors) || keep.contains(p)) continue;
    set.Remove(p);
    removed.push_back(p);
    ForEachNeighbor(p, neighbors, add);
  }
  return removed;
}

void RemoveSimplePoints(ThinSet& set, const PointSet& keep) {
  std::set<LatticePoint> simple;
  set.ForEachPoint([&](LatticePoint p) {
    if (IsSimpleNonEnd(set.NeighborsOf(p))) simple.insert(p);
  });
  RemoveSimplePoints(set, simple, keep);
}

}  // namespace bccskel
