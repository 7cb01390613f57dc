#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_

#include <array>
#include <cstdint>

#include "core/volume/brick.h"

namespace bccskel {

// A brick holds points of one sublattice, so inside it points are adjacent by D6 steps only.

// True when one test of bits shows that the brick's points are connected inside the brick; false
// when they are not or when the test cannot tell.
// Needs: at least one point.
bool IsPlainlyConnected(const BrickBits& points);

// A brick's points in connected components. The largest one is the main component, label 0; there
// are at most 256 (a checkerboard), so a byte holds a label.
struct BrickFragments {
  BrickBits fragments;                            // the points outside the main component
  std::array<uint8_t, kBrickPoints> labels = {};  // by bit; 0 for the main component
  int components = 0;
};

// Needs: at least one point.
BrickFragments SplitBrick(const BrickBits& points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_
