#ifndef BCCSKEL_TESTS_SUPPORT_EVEN_POINTS_H_
#define BCCSKEL_TESTS_SUPPORT_EVEN_POINTS_H_

#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel::test {

struct Voxels {
  std::vector<uint8_t> bits;  // a bit per voxel, x fastest, lowest bit first
  uint64_t count = 0;
};

// An object on the cubic grid, for tools that know no other: the lattice points whose coordinates
// are all even form one, of the extent's cells, and are half of all points.
Voxels EvenPoints(const Volume& object);

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_EVEN_POINTS_H_
