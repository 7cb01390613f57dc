#ifndef BCCSKEL_CORE_PRUNING_SHEET_SET_H_
#define BCCSKEL_CORE_PRUNING_SHEET_SET_H_

#include <functional>
#include <queue>
#include <span>
#include <utility>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/lattice/directions.h"
#include "core/skeleton/thin_points.h"
#include "core/topology/simple_point_table.h"

namespace bccskel {

// The remaining points of a surface skeleton while points are removed. Indexed, unlike ThinSet,
// since sheets have many points: neighbors are close in memory.
class SheetSet {
 public:
  // Contains all of `points`, which must outlive the set.
  explicit SheetSet(const ThinPoints& points)
      : points_(points), masks_(points.size()), left_(points.size(), 1) {
    for (PointIndex p = 0; p < points.size(); ++p) masks_[p] = points.mask(p);
  }

  bool Contains(PointIndex p) const { return left_[p] != 0; }
  // The remaining neighbors; 0 for removed points.
  NeighborMask mask(PointIndex p) const { return masks_[p]; }
  void Remove(PointIndex p) {
    TakeOut(p, points_, masks_);
    left_[p] = 0;
  }
  // The remaining points, in lattice order.
  std::vector<PointIndex> Points() const {
    std::vector<PointIndex> points;
    for (PointIndex p = 0; p < left_.size(); ++p) {
      if (Contains(p)) points.push_back(p);
    }
    return points;
  }

  // Removes points of `from`, then their neighbors, and so on: every point that is simple at its
  // turn and for which `may_go(PointIndex)` is true. The order is by `key(PointIndex)`, smallest
  // first, then lattice order. Returns whether any point was removed.
  template <typename MayGo, typename Key>
  bool RemoveSimple(std::span<const PointIndex> from, MayGo may_go, Key key, StopPoll& poll) {
    using Turn = std::pair<decltype(key(0)), PointIndex>;
    std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns;
    const auto add = [&](PointIndex p) {
      if (IsSimple(masks_[p]) && may_go(p)) turns.emplace(key(p), p);
    };
    for (const PointIndex p : from) add(p);
    bool any = false;
    while (!turns.empty() && !poll.Stopped()) {
      const PointIndex p = turns.top().second;
      turns.pop();
      const NeighborMask neighbors = masks_[p];
      if (!IsSimple(neighbors) || !may_go(p)) continue;
      Remove(p);
      any = true;
      ForEachDirection(neighbors, [&](Direction d) { add(points_.Neighbor(p, d)); });
    }
    return any;
  }

 private:
  const ThinPoints& points_;
  std::vector<NeighborMask> masks_;
  std::vector<uint8_t> left_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SHEET_SET_H_
