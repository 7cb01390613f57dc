#ifndef BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_
#define BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_

#include <cmath>
#include <cstdint>
#include <functional>

#include "tests/support/volume_where.h"

namespace bccskel::test {

// Where a point of a cube of cells lies in the frame of a solid that is turned about the cube's
// middle, its origin.
inline WorldPoint InFrame(LatticePoint p, int32_t cells, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  const double x = p.x - cells, y = p.y - cells, z = p.z - cells;
  const double once = s * x + c * y;
  return {c * x - s * y, c * once - s * z, s * once + c * z};
}

// The points of the cube that lie in the solid.
inline Volume Sampled(const std::function<bool(const WorldPoint&)>& contains, int32_t cells,
                      double turn) {
  return VolumeWhere({cells, cells, cells}, [&](int32_t i, int32_t j, int32_t k) {
    return contains(InFrame({i, j, k}, cells, turn));
  });
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_
