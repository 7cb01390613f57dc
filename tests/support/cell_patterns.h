#ifndef BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_
#define BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_

#include <cstdint>
#include <functional>
#include <utility>

#include "core/volume/volume.h"
#include "tests/support/volume_where.h"

namespace bccskel::test {

// Which of the two points of a cell belong to an object.
using IsIn = std::function<bool(int32_t i, int32_t j, int32_t k, int sublattice)>;

inline bool IsDust(int32_t i, int32_t j, int32_t k, int sublattice) {
  return sublattice == 0 && (i + j + k) % 2 == 0;
}

// Lines along all axes, `step` cells apart.
inline IsIn Net(int32_t step) {
  return [step](int32_t i, int32_t j, int32_t k, int sublattice) {
    return sublattice == 0 && (i % step == 0) + (j % step == 0) + (k % step == 0) >= 2;
  };
}

inline Volume VolumeOfCells(const LatticeExtent& extent, const IsIn& is_in) {
  return VolumeWhere(
      extent, [&](int32_t x, int32_t y, int32_t z) { return is_in(x / 2, y / 2, z / 2, x & 1); });
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_
