#ifndef BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
#define BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/distance/places.h"
#include "core/volume/volume.h"

namespace bccskel {

// Pits per surface point, 0 to about 0.1. A pit is a background point four or more of whose six
// neighbors along the axes are object points; a surface point is an object point that lacks one.
// Smooth objects have 0.01 or less, however they were sampled; flips of 2, 5 and 10 % of the points
// at the surface give 0.02, 0.04 to 0.05, and 0.06 to 0.09.
double Roughness(const Volume& object);

// What sampling may add to how far a branch sticks out.
// Why it depends on the branch: noise makes rows of bumps, which are as thin as a step of the
// surface. What is thicker is a limb, and noise only moves where it begins and ends.
struct SurfaceNoise {
  double step = 1;       // of the surface, lattice units
  double roughness = 0;  // 0: smooth, 1: rough
  double thin = 0;       // lattice units, where the radius is 1.5 steps or less
  double thick = 0;      // the same where it is three steps or more
  // The edges of a voxel in its shortest; steps of the surface are so much higher along each axis.
  AxisScale edges = {1, 1, 1};

  // Of a branch that has this radius where it begins, along the shortest edge of a voxel.
  double At(double radius) const {
    const double thinness = std::clamp(2 - radius / (kThinSteps * step), 0.0, 1.0);
    return thick + (thin - thick) * thinness;
  }
  // How much more it is along this way.
  double Stretch(const Coordinates& way) const {
    if (edges == AxisScale{1, 1, 1}) return 1;
    const Coordinates by_edges = {edges[0] * way[0], edges[1] * way[1], edges[2] * way[2]};
    return std::sqrt(Dot(by_edges, by_edges) / Dot(way, way));
  }

  static constexpr double kThinSteps = 1.5;
};

// One step of the surface and 1.5 units at least where it is smooth, three steps where it is rough;
// one for thick branches of voxels, whose pits Significance looks past.
// Needs: `step`, the length of a step of the surface: 1, or the shortest edge of a voxel; > 0;
//        `slabs` that voxels were cut into along x, y and z.
SurfaceNoise SurfaceNoiseOf(const Volume& object, double step,
                            const std::array<int32_t, 3>& slabs = {1, 1, 1});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
