#ifndef BCCSKEL_CORE_PRUNING_BUMPS_H_
#define BCCSKEL_CORE_PRUNING_BUMPS_H_

#include <cstddef>
#include <span>

#include "core/distance/places.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {

// Distinguishes bumps, object points with few object neighbors, from the points of a limb. Noise
// leaves bumps at the end of a limb, and no tip lies on one.
class Bumps {
 public:
  // `object` must outlive this.
  explicit Bumps(NearbyBricks& object) : object_(object) {}

  // Sets the limit for a limb. A thin limb has no points with many neighbors near its tip, and a
  // limb with a point ends in single points: if `has_point`, there are no bumps.
  // Needs: the limb has a point.
  void SetLimb(std::span<const LatticePoint> limb, bool has_point);
  bool IsFirm(LatticePoint p) { return object_.NeighborsOf(p) >= least_; }
  // Position of the last point of the limb that is no bump; 0 if all are.
  size_t LastFirm(std::span<const LatticePoint> limb);

 private:
  NearbyBricks& object_;
  int least_ = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_BUMPS_H_
