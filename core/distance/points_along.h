#ifndef BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_
#define BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/distance/places.h"

namespace bccskel {

// Lattice points next to positions along a line, stored by axis.
struct PointsAlong {
  static constexpr size_t kCount = 8;

  LatticePoint operator[](size_t n) const { return {axes[0][n], axes[1][n], axes[2][n]}; }

  alignas(64) std::array<std::array<int32_t, kCount>, 3> axes;
};

// Point n is PointNear(from + (first + n) * step * way). Computes several at once, with the same
// bits.
// Needs: the preconditions of PointNear() for each position.
PointsAlong FindPointsAlong(const Coordinates& from, const Coordinates& way, double first,
                            double step, const AxisScale& scale);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_
