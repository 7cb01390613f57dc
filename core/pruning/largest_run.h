#ifndef BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_
#define BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_

#include <cstddef>

#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tip_extender.h"

namespace bccskel {

// The part of a branch that sticks out most relative to its radius, from q = path[from] to p =
// path[to].
struct Run {
  size_t from = 0;  // positions in the path, which begins at the junction
  size_t to = 0;
  double elongation = 0;  // |p - q| - 2 (D(q) - D(p)), D the radius; lattice units
  double ratio = 0;       // (elongation - noise allowance) / D(q)
};

// Widths are measured at so many places of a run, evenly spread.
inline constexpr size_t kRunPlaces = 11;

// Position of one of them in the path.
inline size_t PlaceIn(const Run& run, size_t place) {
  return run.from + (run.to - run.from) * place / (kRunPlaces - 1);
}

// Factor of D(q) - D(p) in the elongation: a part whose radius falls by half its length does not
// stick out.
inline constexpr double kSteepness = 2;

// Finds the run with the largest ratio that begins at position `first` or later. Long paths are
// sampled at 48 positions.
// Needs: at least two points, from the junction, or the middle of a path, to the end.
Run LargestRun(const ThinSet& set, const BranchPath& path, const SurfaceNoise& noise,
               size_t first = 0);

// The largest elongation of any run, at least 0.
double LargestElongation(const ThinSet& set, const BranchPath& path);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_LARGEST_RUN_H_
