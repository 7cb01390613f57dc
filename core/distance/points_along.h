#ifndef BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_
#define BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/distance/places.h"

namespace bccskel {

// Lattice points next to positions on a line, stored by axis.
template <size_t kPoints>
struct PointsOnLine {
  static constexpr size_t kCount = kPoints;

  LatticePoint operator[](size_t n) const { return {axes[0][n], axes[1][n], axes[2][n]}; }

  alignas(8 * kPoints) std::array<std::array<int32_t, kPoints>, 3> axes;
};
using PointsAlong = PointsOnLine<8>;

// Point n is PointNear(from + (first + n) * step * way). Computes several at once, with the same
// bits.
// Needs: the preconditions of PointNear() for each position.
PointsAlong FindPointsAlong(const Coordinates& from, const Coordinates& way, double first,
                            double step, const AxisScale& scale);

// Likewise to both sides: PointNear(from + n * way) for n = out, out + 1, -out, -out - 1.
PointsOnLine<4> FindPointsToBothSides(const Coordinates& from, const Coordinates& way, double out,
                                      const AxisScale& scale);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_POINTS_ALONG_H_
