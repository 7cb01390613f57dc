#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <functional>
#include <random>
#include <vector>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/raw_curves.h"
#include "tests/support/volume_where.h"

// Ribs: false branches in flat limbs, plates and bent walls.

namespace bccskel {
namespace {

using test::EndsOf;

// A flat limb along x, in lattice units: 240 long, 56 wide and 10 thick.
constexpr int32_t kLength = 240, kMiddle = 70, kHalfWidth = 28, kThickness = 10;

// Something that sticks out of the limb's upper rim, as thick as the limb.
struct Arm {
  int32_t x = 0;  // of its middle
  int32_t half_width = 0;
  int32_t length = 0;
};

// A rim with teeth up to `height` high and 6 wide on both sides.
Volume FlatLimb(int32_t height, const std::vector<Arm>& arms, const Placement& placement = {}) {
  std::mt19937_64 random(5);
  std::vector<int32_t> upper, lower;
  for (int32_t x = 0; x < kLength; x += 6) {
    for (auto* rim : {&upper, &lower}) {
      rim->push_back(kHalfWidth -
                     static_cast<int32_t>(random() % static_cast<uint64_t>(height + 1)));
    }
  }
  const auto inside = [&](int32_t x, int32_t y, int32_t /*z*/) {
    const auto tooth = static_cast<size_t>(x / 6);
    const bool in_limb = y <= kMiddle + upper[tooth] && y >= kMiddle - lower[tooth];
    return in_limb || std::ranges::any_of(arms, [&](const Arm& arm) {
             return std::abs(x - arm.x) <= arm.half_width && y >= kMiddle &&
                    y <= kMiddle + kHalfWidth + arm.length;
           });
  };
  return test::VolumeWhere({kLength / 2, kMiddle, kThickness / 2}, inside, placement);
}

// What is inside by its own coordinates, at most `reach` lattice units from its middle, turned
// about two axes.
Volume Turned(double reach, double turn,
              const std::function<bool(double, double, double)>& inside) {
  const auto half = static_cast<int32_t>(reach) + 2;
  const double c = std::cos(turn), s = std::sin(turn);
  const LatticeExtent extent = {half + 1, half + 1, half + 1};
  return test::VolumeWhere(extent, [&](int32_t x, int32_t y, int32_t z) {
    const double px = x - half, py = y - half, pz = z - half;
    const double u = c * px + s * py, w = -s * px + c * py;
    return inside(u, c * w + s * pz, -s * w + c * pz);
  });
}

// In lattice units: `length` by twice `half_width`, or round if it has no length.
struct PlateSize {
  double thickness = 0, length = 0, half_width = 0;
};

Volume Plate(const PlateSize& size, double turn) {
  const double reach = std::hypot(size.length / 2, size.half_width, size.thickness);
  return Turned(reach, turn, [&size](double u, double v, double height) {
    const bool inside = size.length == 0
                            ? std::hypot(u, v) <= size.half_width
                            : std::abs(u) <= size.length / 2 && std::abs(v) <= size.half_width;
    return inside && std::abs(height) <= size.thickness / 2;
  });
}

// Length tells no ribs from limbs, so it shows what is there.
size_t EndsWithRibs(const Volume& object) { return EndsOf(object, {PruningRule::kLength, 3}); }

TEST(Ribs, AreTakenOffFlatLimbsWithRoughRims) {
  for (int32_t height : {0, 4, 6, 8, 10}) {
    SCOPED_TRACE(height);
    const Volume limb = FlatLimb(height, {});
    EXPECT_EQ(EndsOf(limb), 2u);
    EXPECT_GE(EndsWithRibs(limb), height < 8 ? 2u : 12u);
  }
}

// A line across a branch leaves a thin plate soon where it does not lie in it.
TEST(Ribs, DoNotStayOnThinPlatesInAnyPose) {
  for (const double thickness : {4.0, 6.0}) {
    for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
      SCOPED_TRACE(testing::Message() << thickness << ' ' << turn);
      EXPECT_EQ(EndsOf(Plate({thickness, 0, 75}, turn)), 2u);    // round
      EXPECT_LE(EndsOf(Plate({thickness, 160, 30}, turn)), 4u);  // its corners, at most
    }
  }
}

// A wall around the x axis, turned like a plate: half a tube, or three sides of a square with
// edges; `thickness`, `length` and the radius, or half a side, in lattice units.
struct BentSize {
  double thickness = 0, length = 0, radius = 0;
  bool edged = false;
};

Volume BentWall(const BentSize& size, double turn) {
  const double reach = std::hypot(size.length / 2, 2 * size.radius);
  return Turned(reach, turn, [&size](double u, double v, double height) {
    const double out = size.edged ? std::max(std::abs(v), height) : std::hypot(v, height);
    const bool open = height < (size.edged ? -size.radius : 0);
    if (open || std::abs(u) > size.length / 2) return false;
    return std::abs(out - size.radius) <= size.thickness / 2;
  });
}

// A straight line across a branch leaves a bent wall soon.
TEST(Ribs, DoNotStayOnBentWallsInAnyPose) {
  for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
    for (const bool edged : {false, true}) {
      SCOPED_TRACE(testing::Message() << turn << ' ' << edged);
      EXPECT_LE(EndsOf(BentWall({5, 150, 40, edged}, turn)), 4u);  // its corners, at most
    }
  }
}

// In lattice coordinates the limb of the last case would be too narrow.
TEST(Ribs, AreMeasuredAsTheyLieInTheWorld) {
  struct Case {
    std::array<double, 3> spacing;
    int32_t height;
  };
  for (const Case& c :
       {Case{{1.0, 1.0, 1.5}, 6}, Case{{1.0, 2.0, 1.0}, 6}, Case{{1.0, 3.0, 1.0}, 6}}) {
    const Volume limb = FlatLimb(c.height, {}, {.spacing = c.spacing});
    EXPECT_EQ(EndsOf(limb), 2u);
    EXPECT_GE(EndsWithRibs(limb), 7u);
  }
}

TEST(Ribs, AreNotTheArmsAndEarsOfFlatLimbs) {
  for (int32_t height : {0, 4, 8}) {
    for (int32_t half_width : {5, 9}) {
      for (int32_t length : {20, 28, 40}) {
        SCOPED_TRACE(testing::Message() << height << ' ' << half_width << ' ' << length);
        const Arm left = {.x = 95, .half_width = half_width, .length = length};
        const Arm right = {.x = 145, .half_width = half_width, .length = length};
        EXPECT_EQ(EndsOf(FlatLimb(height, {left, right})), 4u);
      }
    }
  }
}

TEST(Ribs, StayWhereTheThresholdIsSmall) {
  const Volume limb = FlatLimb(8, {});
  EXPECT_GE(EndsOf(limb, {PruningRule::kSignificance, 0.02}), 6u);
  EXPECT_EQ(EndsOf(limb, {PruningRule::kSignificance, kDefaultSignificance}), 2u);
}

TEST(Ribs, HaveLevelsThatTellWhatEveryThresholdLeaves) {
  const RawCurves raw(FlatLimb(8, {}), SkeletonKind::kCurve);
  const PointTable<double> levels = test::LevelsOf(raw.PrunedBy(PruningRule::kNone, 0));
  for (double threshold : {0.05, 0.1, 0.2, 0.3, 0.4, 1.0, 4.0}) {
    const Volume pruned = raw.PrunedBy(PruningRule::kSignificance, threshold).points;
    levels.ForEach([&](LatticePoint p, double level) {
      ASSERT_EQ(pruned.Contains(p), level >= threshold) << threshold;
    });
  }
}

// Disks around a shaft, away from its ends. Where in them a curve ended was arbitrary.
TEST(Ribs, OfCollarsAlongAShaftGo) {
  constexpr double kShaft = 12, kHalfThick = 4, kHalfLength = 90;
  for (const double radius : {32.0, 48.0}) {
    for (const double turn : {0.0, 0.3, 0.8, 1.2}) {
      const Volume object = Turned(kHalfLength + 10, turn, [&](double x, double y, double z) {
        const double off = std::hypot(x, y);
        const bool in_collar = std::abs(std::abs(z) - 20) <= kHalfThick && off <= radius;
        return in_collar || (off <= kShaft && std::abs(z) <= kHalfLength);
      });
      EXPECT_EQ(EndsOf(object), 2u) << radius << ' ' << turn;
    }
  }
}

// Four blades, which leave gaps between them, are limbs.
TEST(Ribs, AreNotTheBladesOnAShaft) {
  constexpr double kShaft = 10, kHalfThick = 5, kHalfLength = 60, kReach = 50;
  for (const double turn : {0.0, 0.3, 1.2}) {
    const Volume object = Turned(kHalfLength + 5, turn, [&](double x, double y, double z) {
      const bool in_blade =
          std::min(std::abs(x), std::abs(y)) <= 6 && std::max(std::abs(x), std::abs(y)) <= kReach;
      return (in_blade && std::abs(z) <= kHalfThick) ||
             (std::hypot(x, y) <= kShaft && std::abs(z) <= kHalfLength);
    });
    EXPECT_EQ(EndsOf(object), 6u) << turn;
  }
}

}  // namespace
}  // namespace bccskel
