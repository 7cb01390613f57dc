#ifndef BCCSKEL_CORE_PRUNING_WAY_ON_H_
#define BCCSKEL_CORE_PRUNING_WAY_ON_H_

#include <optional>
#include <span>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// A branch and what may lie beyond its end. Shapes: as many radii as points.
struct BranchPath {
  std::vector<LatticePoint> points;  // the junction first
  std::vector<float> radii;          // lattice units
};

// Follows a limb beyond the end that thinning gave its branch. Thinning ends branches a few lattice
// units before the tips of their limbs, how many differs by pose and sampling: for limbs a few
// points thick that is a large part of how far they stick out.
// Does:  goes on by object points in the way of the last ten points, each the one toward which the
//        radius falls least; kLongest at most. Nothing is added to the set.
// Threads: one thread per instance.
class WayOn {
 public:
  static constexpr double kLongest = 3;        // lattice units
  static constexpr double kLargestRise = 0.5;  // of the radius: beyond, another limb begins

  // Needs: `radius` belongs to `object`, which outlives this.
  WayOn(const Volume& object, const ExactRadius& radius);

  // Needs: at least two points.
  void Append(BranchPath& path);

 private:
  struct Step {
    LatticePoint to;
    float radius = 0;
    double score = 0;
  };

  AxisScale scale_;
  NearbyBricks bricks_;
  ExactRadius radius_;
};

// The way of the path around its point n, of length 1.
Coordinates WayAt(std::span<const LatticePoint> path, size_t n, const AxisScale& scale);

// Adds a place twice the last radius beyond the end, where the border of an image cuts the limb
// off: where the path leads to the border and the ball at its end reaches it. Where a limb ends
// before the border, so does that ball. Not for single points. Returns whether it did.
bool GoOnBeyond(const std::optional<LatticeBox>& image, const AxisScale& scale, BranchPath& path);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_WAY_ON_H_
