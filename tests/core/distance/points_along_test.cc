#include "core/distance/points_along.h"

#include <cmath>
#include <random>

#include "core/exec/instruction_sets.h"
#include "gtest/gtest.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_point_set.h"

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

double WayByPoints(const Volume& object, const Coordinates& from, const Coordinates& way,
                   double start, double reach, const AxisScale& scale) {
  const auto is_in = [&](double along) {
    const LatticePoint p = PointNear(Sum(from, along, way), scale);
    return object.Contains(p);
  };
  double out = start;
  while (out < reach) {
    const int steps = is_in(out + 1) ? 1 : 2;
    if (steps == 2 && !is_in(out + 2)) break;
    out += steps;
  }
  return out;
}

// From inside and outside of an object with holes, to all sides and beyond its extent.
TEST(WayInObject, EndsAtTwoMissingPointsOrWithinReachOnEveryInstructionSet) {
  std::vector<LatticePoint> points = test::RandomBlob(7, {90, 60, 60}, 9, 60);
  std::mt19937 random(6);
  std::erase_if(points, [&](LatticePoint) { return random() % 20 == 0; });
  const Volume object = VolumeOfPoints(points);
  std::uniform_real_distribution<double> part(-1, 1), reach(0, 60);
  for (const std::string& name : exec::SupportedInstructionSets()) {
    SCOPED_TRACE(name);
    ASSERT_TRUE(exec::ChooseInstructionSet(name));
    NearbyBricks nearby(object);
    for (const AxisScale& scale : {kIsotropic, AxisScale{1, 1, 2.5}}) {
      for (int line = 0; line < 3000; ++line) {
        const Coordinates from = PlaceOf(points[random() % points.size()], scale);
        const Coordinates way = Unit({part(random), part(random), part(random)});
        const double start = line % 5,
                     most = line % 2 == 0 ? std::floor(reach(random)) : reach(random);
        ASSERT_EQ(WayInObject(object, nearby, from, way, start, most, scale),
                  WayByPoints(object, from, way, start, most, scale))
            << line;
      }
    }
  }
  exec::ChooseInstructionSet("");
}

}  // namespace
}  // namespace bccskel
