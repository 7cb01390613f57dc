#ifndef BCCSKEL_CORE_PRUNING_THIN_SET_H_
#define BCCSKEL_CORE_PRUNING_THIN_SET_H_

#include <bit>
#include <cmath>
#include <cstddef>
#include <span>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include "core/distance/chamfer_weights.h"
#include "core/lattice/directions.h"
#include "core/volume/volume.h"

namespace bccskel {

struct LatticePointHash {
  size_t operator()(LatticePoint p) const {
    const auto part = [](int32_t v) { return static_cast<uint64_t>(static_cast<uint32_t>(v)); };
    uint64_t hash = part(p.x) * 0x9e3779b97f4a7c15u + part(p.y) * 0xc2b2ae3d27d4eb4fu;
    hash = (hash ^ hash >> 29) + part(p.z) * 0x165667b19e3779f9u;
    return static_cast<size_t>((hash ^ hash >> 32) * 0xd6e8feb86659fd93u);
  }
};

// Tables of the standard library, since they stay whole when an allocation throws. Abseil's do not:
// a resize without memory leaves the new capacity with the old block, and the destructor then frees
// what it never got, which ends the process.
template <typename Value>
using PointMap = std::unordered_map<LatticePoint, Value, LatticePointHash>;
using PointSet = std::unordered_set<LatticePoint, LatticePointHash>;

// A thin volume and what is known of its points, in the order of Volume::ForEachPoint().
struct ThinCurves {
  const Volume& thin;
  std::span<const float> radii;  // lattice units
  // The pass of thinning in which the point became an isthmus, from 1; 0 for points that never did.
  // Empty where the kind of skeleton keeps no isthmuses.
  std::span<const int32_t> births = {};
};

// The points of a thin volume while branches go and tips move: each with its radius, its birth and
// its neighbors in the set.
class ThinSet {
 public:
  explicit ThinSet(const ThinCurves& curves);

  bool Contains(LatticePoint p) const { return points_.contains(p); }
  // Of points of the set.
  float RadiusOf(LatticePoint p) const { return points_.at(p).radius; }
  int32_t BirthOf(LatticePoint p) const { return points_.at(p).birth; }
  NeighborMask NeighborsOf(LatticePoint p) const { return points_.at(p).neighbors; }
  int Degree(LatticePoint p) const;
  // Of any place: the neighbors that are in the set.
  NeighborMask NeighborsAround(LatticePoint p) const;

  void Add(LatticePoint p, float radius);
  void Remove(LatticePoint p);

  // End points, in lattice order.
  std::vector<LatticePoint> Ends() const;

  // Calls visit(LatticePoint) for all points, in any order.
  template <typename Visit>
  void ForEachPoint(Visit visit) const {
    for (const auto& [p, entry] : points_) visit(p);
  }
  // The same for the points on plain curves and ends.
  template <typename Visit>
  void ForEachBranchPoint(Visit visit) const {
    for (const auto& [p, entry] : points_) {
      if (std::popcount(static_cast<unsigned>(entry.neighbors)) <= 2) visit(p);
    }
  }

  // Straight distance in lattice units.
  double Between(LatticePoint a, LatticePoint b) const {
    const double x = scale_[0] * (a.x - b.x), y = scale_[1] * (a.y - b.y),
                 z = scale_[2] * (a.z - b.z);
    return std::sqrt(x * x + y * y + z * z);
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
  PointMap<Entry> points_;
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
