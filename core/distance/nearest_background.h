#ifndef BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_
#define BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_

#include <cstdint>

#include "core/volume/brick.h"

namespace bccskel {

// Whether a brick has no background.
inline bool IsFull(const BrickBits& bits) {
  uint64_t all = ~uint64_t{0};
  for (uint64_t word : bits.words) all &= word;
  return ~all == 0;
}

// Where a point is, seen from a brick. Shapes: both arrays have a number for each of the brick's 32
// rows, row 4k + j.
struct RowSearch {
  int32_t place = 0;   // along x, from the brick's first cell, in lattice coordinates
  float square_x = 1;  // of a lattice coordinate along x
  const float* squared_y = nullptr;
  const float* squared_z = nullptr;
  float below = 0;  // what has this square or a larger one is of no interest
};

struct NearestCell {
  float squared = 0;  // infinite where the brick has no background
  int bit = 0;        // of a cell of interest
};

// The background cell of a brick that is nearest to a point. The square is x * x * square_x + y + z
// in this order, with a rounding after each step.
NearestCell FindNearestBackground(const RowSearch& search, const BrickBits& object);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_NEAREST_BACKGROUND_H_
