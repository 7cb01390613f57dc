#ifndef BCCSKEL_CORE_PRUNING_THIN_SET_H_
#define BCCSKEL_CORE_PRUNING_THIN_SET_H_

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <unordered_set>
#include <vector>

#include "core/distance/chamfer_weights.h"
#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/lattice/directions.h"
#include "core/pruning/point_table.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/topology/neighborhood.h"
#include "core/volume/volume.h"

namespace bccskel {

// From the standard library, since it stays valid when an allocation throws. Abseil's set does not:
// after a failed resize it has the new capacity with the old block, and its destructor then frees
// memory that it never got, which ends the process.
using PointSet = std::unordered_set<LatticePoint, LatticePointHash>;

// The points of a skeleton while branches are removed and tips move, each with its radius, its
// birth and its neighbors in the set.
class ThinSet {
 public:
  // What became of a point of a set made by Over().
  struct Change {
    LatticePoint point;
    NeighborMask neighbors = 0;  // before, whether or not the point was in the set
    bool was_there = false;
    bool is_there = false;
    float radius = 0;  // now, if it is there
  };

  // Empty or incomplete if the context requests a stop.
  explicit ThinSet(const ThinSkeleton& skeleton, const exec::Context& context = {});
  // A set that equals `below` and keeps what changes to itself, so that several workers can try
  // changes of one set. Needs: `below` outlives it and does not change. Members that count, list or
  // visit all points are not for such a set.
  static ThinSet Over(const ThinSet& below);
  // Returns the points that came, went, or got other neighbors or another radius in a set made by
  // Over(), in any order, and forgets them.
  std::vector<Change> TakeChanges();
  // Makes these changes, unless one of the points has come or gone since, or a neighbor of one, so
  // that of two tips that meet at one point only one is applied. Returns whether it did.
  bool Apply(std::span<const Change> changes);

  const AxisScale& scale() const { return scale_; }
  size_t size() const { return points_.size(); }
  bool Contains(LatticePoint p) const { return Find(p) != nullptr; }
  // Need: p is in the set.
  float RadiusOf(LatticePoint p) const { return Find(p)->radius; }
  int32_t BirthOf(LatticePoint p) const { return Find(p)->birth; }
  NeighborMask NeighborsOf(LatticePoint p) const { return Find(p)->neighbors; }
  bool IsEnd(LatticePoint p) const { return IsEndPoint(NeighborsOf(p)); }
  // Whether p has three or more neighbors, as in a junction or a surface.
  bool Branches(LatticePoint p) const { return HasThreeOrMore(NeighborsOf(p)); }
  // The neighbors of any lattice point that are in the set.
  NeighborMask NeighborsAround(LatticePoint p) const;

  void Add(LatticePoint p, float radius);
  void SetRadius(LatticePoint p, float radius) { Own(p).radius = radius; }
  void Remove(LatticePoint p);

  // End points, in lattice order.
  std::vector<LatticePoint> Ends() const;

  // Calls visit(LatticePoint) for all points, in any order.
  template <typename Visit>
  void ForEachPoint(Visit visit) const {
    points_.ForEach([&](LatticePoint p, const Entry&) { visit(p); });
  }

  // Calls visit(LatticePoint, float radius) likewise.
  template <typename Visit>
  void ForEachBall(Visit visit) const {
    points_.ForEach([&](LatticePoint p, const Entry& entry) { visit(p, entry.radius); });
  }

  // Straight distance in lattice units.
  double Between(LatticePoint a, LatticePoint b) const { return StraightDistance(a, b, scale_); }

  // The vector between the points, in lattice units.
  Coordinates Way(LatticePoint from, LatticePoint to) const { return WayBetween(from, to, scale_); }

  // Straight distance to a place between points.
  double Between(LatticePoint a, const Coordinates& place) const {
    return LengthOf(Sum(place, -1, PlaceOf(a, scale_)));
  }

  // The points as a skeleton on the grid of `like`, with its births: points that were removed and
  // added again keep theirs.
  ThinSkeleton ToSkeleton(const ThinSkeleton& like) const;

 private:
  struct Entry {
    float radius = 0;
    int32_t birth = 0;
    NeighborMask neighbors = 0;
    bool gone = false;  // not in the set, unlike in the one below
  };

  explicit ThinSet(const AxisScale& scale) : scale_(scale) {}

  // Null if the point is not in the set.
  const Entry* Find(LatticePoint p) const {
    if (below_ == nullptr) return points_.Find(p);
    const Entry* changed = points_.empty() ? nullptr : points_.Find(p);
    if (changed == nullptr) return below_->points_.Find(p);
    return changed->gone ? nullptr : changed;
  }
  // The entry of a point of the set, to be changed.
  Entry& Own(LatticePoint p);

  AxisScale scale_;
  const ThinSet* below_ = nullptr;  // of a set made by Over()
  PointTable<Entry> points_;        // those that changed, if there is a set below
};

// Calls visit(LatticePoint) for the neighbors in `mask`, in the order of kDirections14.
template <typename Visit>
void ForEachNeighbor(LatticePoint p, NeighborMask mask, Visit visit) {
  ForEachDirection(mask, [&](Direction d) { visit(p + d.offset()); });
}

// Needs: at least one value.
template <typename Value>
double MedianOf(std::vector<Value> values) {
  const auto median = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, median);
  return *median;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_THIN_SET_H_
