#ifndef BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
#define BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/distance/places.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

// Pits per surface point, 0 to about 0.1. A pit is a background point with at least four object
// points among its six axial neighbors; a surface point is an object point with a background point
// among them. Smooth objects have at most 0.01, however they were sampled; flipping 2, 5 and 10 %
// of the surface points gives 0.02, 0.04 to 0.05, and 0.06 to 0.09.
double Roughness(const Volume& object, const exec::Context& context = {});

// The noise allowance: what sampling may add to how far a branch sticks out.
// Why it depends on the branch: noise makes rows of bumps that are as thin as one step of the
// surface. A thicker branch is a limb; noise only moves its two ends.
struct SurfaceNoise {
  double step = 1;       // a step of the surface, lattice units
  double roughness = 0;  // 0: smooth, 1: rough
  double thin = 0;       // allowance for radii of 1.5 steps or less, lattice units
  double thick = 0;      // allowance for radii of three steps or more
  // The edges of a voxel divided by its shortest edge: the factors by which steps of the surface
  // grow along each axis.
  AxisScale edges = {1, 1, 1};

  // The allowance for a branch with this radius where it begins, along the shortest edge of a
  // voxel.
  double At(double radius) const {
    const double thinness = std::clamp(2 - radius / (kThinSteps * step), 0.0, 1.0);
    return thick + (thin - thick) * thinness;
  }
  // The factor of the allowance along this direction.
  double Stretch(const Coordinates& way) const {
    if (edges == AxisScale{1, 1, 1}) return 1;
    const Coordinates by_edges = {edges[0] * way[0], edges[1] * way[1], edges[2] * way[2]};
    return std::sqrt(Dot(by_edges, by_edges) / Dot(way, way));
  }

  // What is left of how far a branch sticks out beyond the allowance and a margin, if its radius
  // where it begins is `radius` and it leads in the direction of `way`; negative within them.
  double Beyond(double elongation, double radius, const Coordinates& way) const;

  static constexpr double kThinSteps = 1.5;
  static constexpr double kMargin = 2;  // units more, since squares are subtracted
};

// Measures the allowance: at least one step of the surface and 1.5 units where the surface is
// smooth, three steps where it is rough; for thick branches of voxels always as for a smooth
// surface, since Significance ignores their pits.
// Needs: `step`, the length of a step of the surface: 1, or the shortest edge of a voxel; > 0.
//        `slabs`: into how many each voxel was cut along x, y and z.
SurfaceNoise SurfaceNoiseOf(const Volume& object, double step,
                            const std::array<int32_t, 3>& slabs = {1, 1, 1},
                            const exec::Context& context = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
