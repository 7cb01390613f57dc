#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/volume/brick.h"

namespace bccskel {

// A brick holds points of one sublattice, so inside it points are adjacent by D6 steps only.

enum class Phase : uint8_t { kObject, kBackground };

// What a single bit test shows about the points of a brick.
enum class Connectivity : uint8_t {
  kEmpty,
  kConnected,  // inside the brick
  kUnclear,
};

// The points, or the background points, of each brick.
// Shapes: one entry of `points` and of `found` per brick.
void TestConnectivity(std::span<const BrickBits> bricks, Phase phase, std::span<BrickBits> points,
                      std::span<Connectivity> found);

// A brick's points in connected components. The largest one is the main component, label 0; there
// are at most 256 (a checkerboard), so a byte holds a label.
struct BrickFragments {
  BrickBits fragments;                            // the points outside the main component
  std::array<uint8_t, kBrickPoints> labels = {};  // by bit; 0 for the main component
  int components = 0;
  size_t first_number = 0;  // of the component with label 1, where components are numbered
};

// Needs: at least one point.
bool IsConnected(const BrickBits& points);

// Needs: at least one point.
BrickFragments SplitBrick(const BrickBits& points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_COMPONENTS_H_
