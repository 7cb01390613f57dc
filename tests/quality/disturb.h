#ifndef BCCSKEL_TESTS_QUALITY_DISTURB_H_
#define BCCSKEL_TESTS_QUALITY_DISTURB_H_

#include <array>
#include <cstdint>

#include "core/volume/volume.h"

// The same object in other words: what a skeleton should not depend on.

namespace bccskel::quality {

// Flips about `fraction` of the points on either side of the boundary, in random order, each only
// if that keeps the topology at its turn.
Volume WithTopologyKeepingNoise(const Volume& object, double fraction, uint64_t seed);

// One of the 24 rotations that take the axes to the axes: coordinate n comes from axis[n], times
// sign[n].
struct GridRotation {
  std::array<int, 3> axis;
  std::array<int, 3> sign;
};
std::array<GridRotation, 24> GridRotations();

struct TurnedVolume {
  Volume object;
  LatticePoint shift;  // a point p went to rotation(p) + shift
};
TurnedVolume TurnedOnGrid(const Volume& object, const GridRotation& rotation);
LatticePoint TurnOnGrid(LatticePoint p, const GridRotation& rotation);
LatticePoint TurnBackOnGrid(LatticePoint p, const GridRotation& rotation);

}  // namespace bccskel::quality

#endif  // BCCSKEL_TESTS_QUALITY_DISTURB_H_
