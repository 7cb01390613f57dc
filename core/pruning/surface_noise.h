#ifndef BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
#define BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_

#include <algorithm>

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

  // Of a branch that has this radius where it begins.
  double At(double radius) const {
    const double thinness = std::clamp(2 - radius / (kThinSteps * step), 0.0, 1.0);
    return thick + (thin - thick) * thinness;
  }

  static constexpr double kThinSteps = 1.5;
};

// One step of the surface and 1.5 units at least where it is smooth, three steps where it is rough;
// one for thick branches of voxels, whose pits Significance looks past.
// Needs: `step`, the length of a step of the surface: 1, or the edge of a voxel; > 0.
SurfaceNoise SurfaceNoiseOf(const Volume& object, double step);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
