#ifndef BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_
#define BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_

#include <cstddef>

#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/way_on.h"

namespace bccskel {

// The part of a branch that sticks out most for its radius.
struct Run {
  size_t from = 0;  // positions in the path, the junction's end first
  size_t to = 0;
  double elongation = 0;  // |p - q| - 2 (D(q) - D(p)) from q to p, lattice units
  double ratio = 0;       // what of that is no noise, in radii at `from`
};

// So much of what the radius falls by counts against a limb: all of it where it falls by half the
// way.
inline constexpr double kSteepness = 2;

// Needs: at least two points, from the junction, or the middle of a path, to the end. The run
// begins at position `first` or later. Long paths are sampled at 48 positions.
Run LargestRun(const ThinSet& set, const BranchPath& path, const SurfaceNoise& noise,
               size_t first = 0);

// The largest elongation of a run, whatever its radius; 0 or more.
double LargestElongation(const ThinSet& set, const BranchPath& path);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_
