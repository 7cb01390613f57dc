#ifndef BCCSKEL_CORE_PRUNING_THIN_SET_H_
#define BCCSKEL_CORE_PRUNING_THIN_SET_H_

#include <bit>
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
#include "core/volume/volume.h"

namespace bccskel {

// A table of the standard library, since it stays whole when an allocation throws. Abseil's does
// not: a resize without memory leaves the new capacity with the old block, and the destructor then
// frees what it never got, which ends the process.
using PointSet = std::unordered_set<LatticePoint, LatticePointHash>;

// A thin volume and what is known of its points, in the order of Volume::ForEachPoint().
struct ThinCurves {
  const Volume& thin;
  std::span<const float> radii;  // lattice units
  // The pass of thinning in which the point became an isthmus, from 1; 0 for points that never did.
  // Empty where the kind of skeleton keeps no isthmuses.
  std::span<const int32_t> births = {};
  // Lattice units: 1 where the object's surface was sampled point by point, else a voxel's edge.
  double surface_step = 1;
  // Where widths and depths are measured, if not in the object: the same with points beyond the
  // border.
  const Volume* space = nullptr;
};

// The points of a thin volume while branches go and tips move: each with its radius, its birth and
// its neighbors in the set.
class ThinSet {
 public:
  // Empty or incomplete where the context says to stop.
  explicit ThinSet(const ThinCurves& curves, const exec::Context& context = {});

  bool Contains(LatticePoint p) const { return points_.Find(p) != nullptr; }
  // Of points of the set.
  float RadiusOf(LatticePoint p) const { return points_.Find(p)->radius; }
  int32_t BirthOf(LatticePoint p) const { return points_.Find(p)->birth; }
  NeighborMask NeighborsOf(LatticePoint p) const { return points_.Find(p)->neighbors; }
  int Degree(LatticePoint p) const;
  // Of any place: the neighbors that are in the set.
  NeighborMask NeighborsAround(LatticePoint p) const;

  void Add(LatticePoint p, float radius);
  void SetRadius(LatticePoint p, float radius) { points_.Find(p)->radius = radius; }  // of the set
  void Remove(LatticePoint p);

  // End points, in lattice order.
  std::vector<LatticePoint> Ends() const;

  // Calls visit(LatticePoint) for all points, in any order.
  template <typename Visit>
  void ForEachPoint(Visit visit) const {
    points_.ForEach([&](LatticePoint p, const Entry&) { visit(p); });
  }
  // The same for the points on plain curves and ends.
  template <typename Visit>
  void ForEachBranchPoint(Visit visit) const {
    points_.ForEach([&](LatticePoint p, const Entry& entry) {
      if (std::popcount(static_cast<unsigned>(entry.neighbors)) <= 2) visit(p);
    });
  }

  // Straight distance in lattice units.
  double Between(LatticePoint a, LatticePoint b) const {
    const double x = scale_[0] * (a.x - b.x), y = scale_[1] * (a.y - b.y),
                 z = scale_[2] * (a.z - b.z);
    return std::sqrt(x * x + y * y + z * z);
  }

  // The same to a place between points.
  double Between(LatticePoint a, const Coordinates& place) const {
    const Coordinates way = Sum(place, -1, PlaceOf(a, scale_));
    return std::sqrt(Dot(way, way));
  }

  // The points as a volume on the grid of `thin`, and their radii in its order.
  Volume ToVolume(const Volume& thin) const;
  std::vector<float> RadiiOf(const Volume& volume) const;

 private:
  struct Entry {
    float radius = 0;
    int32_t birth = 0;
    NeighborMask neighbors = 0;
  };

  AxisScale scale_;
  PointTable<Entry> points_;
};

// Calls visit(LatticePoint) for the neighbors in `mask`, in the order of kDirections14.
template <typename Visit>
void ForEachNeighbor(LatticePoint p, NeighborMask mask, Visit visit) {
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    visit(p + kDirections14[static_cast<size_t>(std::countr_zero(rest))]);
  }
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_THIN_SET_H_
