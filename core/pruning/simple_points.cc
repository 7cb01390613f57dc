#include "core/pruning/simple_points.h"

#include <utility>

#include "core/topology/neighborhood.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {

std::vector<LatticePoint> RemoveSimplePoints(ThinSet& set, const std::set<LatticePoint>& from,
                                             const PointSet& keep, StopPoll* poll) {
  std::vector<LatticePoint> removed;
  std::set<std::pair<float, LatticePoint>> turns;
  const auto add = [&](LatticePoint p) { turns.emplace(set.RadiusOf(p), p); };
  for (LatticePoint p : from) add(p);
  while (!turns.empty() && (poll == nullptr || !poll->Stopped())) {
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

void RemoveSimplePoints(ThinSet& set, const PointSet& keep, StopPoll& poll) {
  std::set<LatticePoint> simple;
  set.ForEachPoint([&](LatticePoint p) {
    if (!poll.Stopped() && IsSimpleNonEnd(set.NeighborsOf(p))) simple.insert(p);
  });
  RemoveSimplePoints(set, simple, keep, &poll);
}

RemovedBranch RemoveBranch(ThinSet& set, const FreeBranch& branch, const PointSet& keep) {
  const LatticePoint junction = *branch.junction;
  RemovedBranch removed = {branch.points, {junction}};
  for (LatticePoint p : branch.points) set.Remove(p);
  const auto add = [&](LatticePoint q) { removed.around.insert(q); };
  ForEachNeighbor(junction, set.NeighborsOf(junction), add);
  for (LatticePoint p : RemoveSimplePoints(set, removed.around, keep)) {
    removed.points.push_back(p);
    ForEachNeighbor(p, set.NeighborsAround(p), add);
  }
  return removed;
}

}  // namespace bccskel
