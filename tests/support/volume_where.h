#ifndef BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_
#define BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_

#include <cstdint>
#include <utility>

#include "core/volume/volume.h"

namespace bccskel::test {

// Calls `visit(x, y, z)` for the lattice points of a box of `cells` cells.
template <typename Visit>
void ForEachPointOf(LatticeExtent cells, const Visit& visit) {
  for (int32_t z = 0; z < 2 * cells.nz; ++z) {
    for (int32_t y = z & 1; y < 2 * cells.ny; y += 2) {
      for (int32_t x = z & 1; x < 2 * cells.nx; x += 2) visit(x, y, z);
    }
  }
}

// Those for which `inside(x, y, z)` holds.
template <typename IsIn>
Volume VolumeWhere(LatticeExtent cells, const IsIn& inside, const Placement& placement = {}) {
  VolumeBuilder builder(cells, placement);
  ForEachPointOf(cells, [&](int32_t x, int32_t y, int32_t z) {
    if (inside(x, y, z)) builder.Add({x, y, z});
  });
  return *std::move(builder).Build();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_
