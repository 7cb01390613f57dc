#ifndef BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_
#define BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_

#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Level of points that no branch with a level runs through.
inline constexpr double kNoLevel = -1;

// The points that thinning leaves and what is known of each: what the stages after it hand on.
// Shapes: one value per point, in the order of Volume::ForEachPoint().
struct ThinSkeleton {
  Volume points;
  std::vector<float> radii;  // lattice units
  // The pass of thinning in which the point became an isthmus, from 1; 0 for points that never did.
  // Empty where the kind of skeleton keeps no isthmuses.
  std::vector<int32_t> births = {};
  // The threshold above which pruning removes the point's branch, by persistence where that was the
  // rule, or none was and births are known, else by significance; infinity where it never does,
  // kNoLevel for points at junctions and those by which tips have grown. Empty if nothing was
  // pruned by branches.
  std::vector<double> levels = {};
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_THIN_SKELETON_H_
