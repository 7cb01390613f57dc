#ifndef BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_
#define BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_

#include <array>
#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Points for each of the axes x, y and z.
using PointsByAxis = std::array<std::vector<LatticePoint>, 3>;

// Level of points that are on no branch with a level.
inline constexpr double kNoLevel = -1;

// The points that thinning leaves and their attributes, which the later stages pass on.
// Shapes: one value per point, in the order of Volume::ForEachPoint().
struct ThinSkeleton {
  Volume points;
  std::vector<float> radii;  // lattice units
  // The pass of thinning in which the point became an isthmus, from 1; 0 for points that never did.
  // Empty if the kind of skeleton keeps no isthmuses.
  std::vector<int32_t> births = {};
  // The threshold above which pruning removes the point's branch: by persistence if that was the
  // rule, or if there was no rule and births are known; otherwise by significance. Infinity if it
  // is never removed; kNoLevel for points at junctions and those added by growing tips. Empty if
  // branches were not pruned.
  std::vector<double> levels = {};
  // Some of the points: of curves led to the middle of a cut at the border of the image, by the
  // axis across which that cuts.
  PointsByAxis at_border = {};
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_
