#include "core/distance/points_along.h"

#include <cmath>
#include <random>

#include "gtest/gtest.h"

namespace bccskel {
namespace {

// Random lines, and lines through lattice points and halfway between them, where ties are.
TEST(PointsAlong, AreThoseNextToEachPlace) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> place(-20, 300), part(-1, 1);
  for (const AxisScale& scale : {kIsotropic, AxisScale{1, 1, 2.5}, AxisScale{1.3, 1, 1.7}}) {
    for (int line = 0; line < 3000; ++line) {
      Coordinates from = {place(random), place(random), place(random)};
      Coordinates way = {part(random), part(random), part(random)};
      if (line % 3 == 0) {
        for (size_t axis = 0; axis < 3; ++axis) {
          from[axis] = scale[axis] * std::floor(from[axis]) / 2;
          way[axis] = scale[axis] * std::round(2 * way[axis]) / 2;
        }
      }
      const double first = line % 7 - 3, step = line % 2 == 0 ? 1 : 1.37;
      const PointsAlong points = FindPointsAlong(from, way, first, step, scale);
      for (size_t n = 0; n < PointsAlong::kCount; ++n) {
        const double along = (first + static_cast<double>(n)) * step;
        ASSERT_EQ(points[n], PointNear(Sum(from, along, way), scale)) << line << " " << n;
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
