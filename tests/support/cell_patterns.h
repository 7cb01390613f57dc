#ifndef BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_
#define BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_

#include <cstdint>
#include <functional>
#include <utility>

#include "core/volume/volume.h"

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
  VolumeBuilder builder(extent);
  for (int32_t k = 0; k < extent.nz; ++k) {
    for (int32_t j = 0; j < extent.ny; ++j) {
      for (int32_t i = 0; i < extent.nx; ++i) {
        for (const int s : {0, 1}) {
          if (is_in(i, j, k, s)) builder.Add({2 * i + s, 2 * j + s, 2 * k + s});
        }
      }
    }
  }
  return *std::move(builder).Build();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_SUPPORT_CELL_PATTERNS_H_
