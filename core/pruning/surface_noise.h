#ifndef BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
#define BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_

#include "core/volume/volume.h"

namespace bccskel {

// Pits per surface point, 0 to about 0.1. A pit is a background point four or more of whose six
// neighbors along the axes are object points; a surface point is an object point that lacks one.
// Smooth objects have 0.01 or less, however they were sampled; flips of 2, 5 and 10 % of the points
// at the surface give 0.02, 0.04 to 0.05, and 0.06 to 0.09.
double Roughness(const Volume& object);

// What sampling may add to how far a branch sticks out, lattice units: one step of the surface
// and 1.5 units at least where it is smooth, three where it is rough.
// Needs: `step`, the length of a step of the surface: 1, or the edge of a voxel; > 0.
double SurfaceNoise(const Volume& object, double step);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SURFACE_NOISE_H_
