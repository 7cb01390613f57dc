#ifndef BCCSKEL_CORE_SKELETON_THIN_POINTS_H_
#define BCCSKEL_CORE_SKELETON_THIN_POINTS_H_

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/stop_poll.h"
#include "core/lattice/directions.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/skeleton/thin_skeleton.h"

namespace bccskel {

// Position of a point in ThinPoints.
using PointIndex = uint32_t;

// The points of a skeleton as a list in lattice order, with their attributes and neighbors.
// Translating the volume translates the list: results do not depend on bricks.
class ThinPoints {
 public:
  // Incomplete if `poll` requests a stop.
  ThinPoints(const ThinSkeleton& skeleton, StopPoll& poll);
  // The points of `all` with the indices `some`, which increase.
  ThinPoints(const ThinPoints& all, std::span<const PointIndex> some, StopPoll& poll);

  size_t size() const { return points_.size(); }
  const SkeletonPoint& operator[](PointIndex p) const { return points_[p].at; }
  double level(PointIndex p) const { return points_[p].level; }  // kNoLevel if it has none
  // The point with the largest radius, on ties the smallest. Needs: at least one point.
  PointIndex DeepestOf(std::span<const PointIndex> some) const;
  NeighborMask mask(PointIndex p) const { return masks_[p]; }
  // Needs: mask(p) has d.
  PointIndex Neighbor(PointIndex p, Direction d) const {
    return neighbors_[p][static_cast<size_t>(d.bit())];
  }
  // Needs: two neighbors.
  std::array<PointIndex, 2> BothNeighbors(PointIndex p) const {
    const auto mask = static_cast<unsigned>(masks_[p]);
    return {neighbors_[p][static_cast<size_t>(std::countr_zero(mask))],
            neighbors_[p][static_cast<size_t>(std::bit_width(mask) - 1)]};
  }

 private:
  struct Point {
    SkeletonPoint at;
    double level = kNoLevel;
  };

  void Gather(const ThinSkeleton& skeleton, StopPoll& poll);
  template <typename Key>
  void FindNeighbors(StopPoll& poll);
  template <typename Key>
  void LinkAlong(Direction d, std::span<const Key> keys, StopPoll& poll);

  std::vector<Point> points_;
  std::vector<NeighborMask> masks_;
  std::vector<std::array<PointIndex, kNeighborCount>> neighbors_;  // by direction
};

// Removes p from the masks of its neighbors and these from the mask of p. Shapes: one mask per
// point.
inline void TakeOut(PointIndex p, const ThinPoints& points, std::span<NeighborMask> masks) {
  ForEachDirection(masks[p], [&](Direction d) {
    NeighborMask& mask = masks[points.Neighbor(p, d)];
    mask = Without(mask, d.Opposite());
  });
  masks[p] = 0;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_THIN_POINTS_H_
