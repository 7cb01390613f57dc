// Limbs whose last part thinning reaches: feet, beaks and teeth keep their curves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::Joined;
using test::ToLimb;

// The way to the toes leads aside from that of the leg.
TEST(LastParts, FeetKeepTheirCurves) {
  constexpr int32_t kCells = 90;
  for (const double radius : {6.0, 12.0}) {
    for (const double length : {2.0, 2.5, 3.0}) {  // radii
      const WorldPoint hip = {-80, 0, 0}, ankle = {20, 0, 0}, toe = {20, length * radius, 0};
      const auto leg = [&](const WorldPoint& p) {
        return std::min(ToLimb(p, hip, radius, ankle, radius),
                        ToLimb(p, ankle, radius, toe, radius)) <= 0;
      };
      for (const double turn : {0.0, 0.3, 0.8}) {
        const auto result = Skeletonize(test::Sampled(leg, kCells, turn), {}, {});
        ASSERT_TRUE(result.ok()) << result.status();
        EXPECT_LT(GapAt(toe, result->graph, kCells, turn), 0.4 * radius + 2)
            << radius << ' ' << length << ' ' << turn;
        EXPECT_EQ(result->graph.nodes.size(), 2u);
      }
    }
  }
}

// The head is thicker than any other part of the limb, which begins with the neck.
TEST(LastParts, BeaksKeepTheirCurves) {
  constexpr int32_t kCells = 90;
  constexpr double kHead = 17, kPoint = 1.5;
  for (const double length : {1.0, 1.3}) {  // beyond the head, in its radii
    const WorldPoint center = {0, 0, 0}, body = {-2.5 * kHead, 0, -4.375 * kHead},
                     throat = {kHead / 2, 0, 0};
    const WorldPoint tip = {kHead * (1 + length) - kPoint, 0, 0};
    const auto bird = [&](const WorldPoint& p) {
      const double neck = ToLimb(p, center, 0.75 * kHead, body, 1.2 * kHead);
      const double head = Joined(neck, ToLimb(p, center, kHead, center, kHead), 0.125 * kHead);
      return Joined(head, ToLimb(p, throat, 0.45 * kHead, tip, kPoint), 0.125 * kHead) <= 0;
    };
    for (const double turn : {0.0, 0.4, 1.0, 1.6, 2.8}) {
      const auto result = Skeletonize(test::Sampled(bird, kCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_LT(GapAt(tip, result->graph, kCells, turn), kHead / 2) << length << ' ' << turn;
    }
  }
}

// Their last points have few neighbors, as bumps have. The cones end in balls of one unit.
TEST(LastParts, ConesKeepTheirPoints) {
  constexpr int32_t kCells = 60;
  constexpr double kBall = 29, kFoot = 6.4, kHeight = 18;
  std::array<WorldPoint, 6> ways = {};
  for (size_t n = 0; n < ways.size(); ++n) ways[n][n / 2] = n % 2 == 0 ? 1 : -1;
  const auto at = [](const WorldPoint& way, double out) {
    return WorldPoint{out * way[0], out * way[1], out * way[2]};
  };
  const auto mace = [&](const WorldPoint& p) {
    double distance = ToLimb(p, {0, 0, 0}, kBall, {0, 0, 0}, kBall);
    for (const WorldPoint& way : ways) {
      distance = std::min(distance,
                          ToLimb(p, at(way, 0.9 * kBall), kFoot, at(way, kBall + kHeight - 1), 1));
    }
    return distance <= 0;
  };
  for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
    const auto result = Skeletonize(test::Sampled(mace, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    for (const WorldPoint& way : ways) {
      EXPECT_LT(GapAt(at(way, kBall + kHeight), result->graph, kCells, turn), 4) << turn;
    }
  }
}

// The way into a tooth comes through a disk, which is wider than any limb.
TEST(LastParts, TeethOfADiskKeepTheirCurves) {
  constexpr int32_t kCells = 110, kTeeth = 8;
  constexpr double kDisk = 72, kHalfThickness = 9, kTooth = 27;  // wide and high
  const auto gear = [&](const WorldPoint& p) {
    if (std::abs(p[2]) > kHalfThickness) return false;
    if (std::hypot(p[0], p[1]) <= kDisk) return true;
    for (int n = 0; n < kTeeth; ++n) {
      const double angle = 2 * std::numbers::pi * n / kTeeth;
      const double out = p[0] * std::cos(angle) + p[1] * std::sin(angle);
      const double aside = p[1] * std::cos(angle) - p[0] * std::sin(angle);
      if (out > 0 && out <= kDisk + kTooth && std::abs(aside) <= kTooth / 2) return true;
    }
    return false;
  };
  for (const double turn : {0.22, 3.18}) {
    const auto result = Skeletonize(test::Sampled(gear, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    for (int n = 0; n < kTeeth; ++n) {
      const double angle = 2 * std::numbers::pi * n / kTeeth, out = kDisk + kTooth / 2;
      const WorldPoint tooth = {out * std::cos(angle), out * std::sin(angle), 0};
      EXPECT_LT(GapAt(tooth, result->graph, kCells, turn), 0.6 * kTooth) << turn << ' ' << n;
    }
  }
}

// The curve into a pear turns from the vessel's way and gets thinner by 0.4 per unit.
TEST(LastParts, PearsKeepTheirPoints) {
  constexpr int32_t kCells = 80;
  const WorldPoint center = {0, 0, 0}, point = {0, 0, -45};
  const std::array<WorldPoint, 5> vessel = {
      center, {9, 0, 28}, {27, 0, 35}, {45, 0, 50}, {60, 0, 68}};
  const auto pear = [&](const WorldPoint& p) {
    double distance = ToLimb(p, center, 27, point, 9);
    for (size_t n = 1; n < vessel.size(); ++n) {
      distance = std::min(distance, ToLimb(p, vessel[n - 1], 6, vessel[n], 6));
    }
    return distance <= 0;
  };
  for (const double turn : {0.0, 0.4, 1.0, 1.6, 2.8}) {
    const auto result = Skeletonize(test::Sampled(pear, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_LT(GapAt(point, result->graph, kCells, turn), 5) << turn;
  }
}

// Of the curves from the middle of a disc to its rim pruning leaves the last one, which then
// continues the shaft.
TEST(LastParts, DiscsOnShaftsEndTheCurveInTheirMiddle) {
  constexpr int32_t kCells = 80;
  constexpr double kShaft = 6;
  for (const double half_thickness : {0.6, 0.8, 1.2}) {
    const double rim = (half_thickness < 0.7 ? 6 : 4) * kShaft;
    const auto nail = [&](const WorldPoint& p) {
      const double out = std::hypot(p[1], p[2]);
      const bool in_disc = out <= rim && std::abs(p[0] - 40) <= half_thickness * kShaft;
      return in_disc || (out <= kShaft && p[0] > -60 && p[0] < 40);
    };
    for (const double turn : {0.0, 0.3, 0.8}) {
      const auto result = Skeletonize(test::Sampled(nail, kCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_LT(GapAt({40, 0, 0}, result->graph, kCells, turn), 1.5 * kShaft)
          << half_thickness << ' ' << turn;
    }
  }
}

}  // namespace
}  // namespace bccskel
