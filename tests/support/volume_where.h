#ifndef BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_
#define BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_

#include <cstdint>
#include <span>
#include <utility>

#include "core/volume/volume.h"

namespace bccskel::test {

// Calls `visit(LatticePoint)` for the lattice points of a box, in their order.
template <typename Visit>
void ForEachPointIn(const LatticeBox& box, const Visit& visit) {
  for (int32_t z = box.low.z; z <= box.high.z; ++z) {
    for (int32_t y = box.low.y; y <= box.high.y; ++y) {
      for (int32_t x = box.low.x; x <= box.high.x; ++x) {
        if (IsOnLattice({x, y, z})) visit(LatticePoint{x, y, z});
      }
    }
  }
}

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

// All of them.
inline Volume FullVolume(LatticeExtent cells, const Placement& placement = {}) {
  return VolumeWhere(
      cells, [](auto...) { return true; }, placement);
}

// A volume of full bricks, so many along each axis.
inline Volume FullBricks(int32_t along_x, int32_t along_y, int32_t along_z) {
  VolumeBuilder builder({along_x * kBrickX, along_y * kBrickY, along_z * kBrickZ});
  ForEachPointOf({along_x, along_y, along_z}, [&](int32_t x, int32_t y, int32_t z) {
    const BrickCoordinates brick = {x / 2, y / 2, z / 2, SublatticeOf({x, y, z})};
    builder.Brick(BrickKey(brick)).words.fill(~uint64_t{0});
  });
  return *std::move(builder).Build();
}

// Those of the points that lie in the box.
inline Volume VolumeWith(std::span<const LatticePoint> points, LatticeExtent cells,
                         const Placement& placement = {}) {
  VolumeBuilder builder(cells, placement);
  for (const LatticePoint p : points) builder.Add(p);
  return *std::move(builder).Build();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_VOLUME_WHERE_H_
