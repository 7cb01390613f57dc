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

using test::Sampled;

// The radii of the ends of a path, in lattice units, the smaller first.
std::array<double, 2> EndRadiiOf(const Volume& object) {
  const auto result = Skeletonize(object, {}, {});
  EXPECT_TRUE(result.ok()) << result.status();
  const SkeletonGraph& graph = result->graph;
  EXPECT_EQ(graph.nodes.size(), 2u);
  if (graph.nodes.size() != 2) return {0, 0};
  const double scale = 2;  // a spacing of 1 is two units
  const double a = scale * graph.RadiusOf(graph.nodes[0].at);
  const double b = scale * graph.RadiusOf(graph.nodes[1].at);
  return {std::min(a, b), std::max(a, b)};
}

// The axis ends a radius before the face. From the way that the limb came, its rim is straight on.
TEST(CutLimbs, ThatBendEndOnTheirAxes) {
  constexpr double kRadius = 12;
  for (const double bend : {3.0, 4.0, 5.0}) {  // radii
    const auto half_ring = [&](const WorldPoint& p) {
      const double out = std::hypot(p[0], p[1]) - bend * kRadius;
      return p[0] >= 0 && std::hypot(out, p[2]) <= kRadius;
    };
    for (const double turn : {0.3, 0.7, 1.1}) {
      const auto [least, most] = EndRadiiOf(Sampled(half_ring, 76, turn));
      EXPECT_GT(least, 0.8 * kRadius) << bend << ' ' << turn;
      EXPECT_LT(most, 1.1 * kRadius);
    }
  }
}

// Thinning leads the path into a corner, sqrt(5) radii from where it should end.
TEST(CutLimbs, WithThreeSidesEndOnTheirAxes) {
  constexpr double kRadius = 22;                 // inscribed
  for (const double half_length : {2.5, 4.0}) {  // radii
    const auto bar = [&](const WorldPoint& p) {
      const double z = std::sqrt(3) / 2 * std::abs(p[2]);
      return p[1] <= kRadius && z - 0.5 * p[1] <= kRadius &&
             std::abs(p[0]) <= half_length * kRadius;
    };
    EXPECT_GT(EndRadiiOf(Sampled(bar, 100, 0.4))[0], 0.8 * kRadius) << half_length;
  }
}

// Thinning leads the path into the corner that is less than a right angle. Of a chisel, cut at 60
// degrees, that corner is the tip.
TEST(CutLimbs, AtASlantEndOnTheirAxes) {
  constexpr double kRadius = 16, kHalfLength = 80;
  for (const double slant : {20.0, 30.0}) {  // degrees
    const double tangent = std::tan(slant * std::numbers::pi / 180);
    for (const bool is_round : {true, false}) {
      const auto bar = [&](const WorldPoint& p) {
        const double across =
            is_round ? std::hypot(p[1], p[2]) : std::max(std::abs(p[1]), std::abs(p[2]));
        return across <= kRadius && std::abs(p[0] - tangent * p[1]) <= kHalfLength;
      };
      for (const double turn : {0.3, 0.8}) {
        const double least = EndRadiiOf(Sampled(bar, 110, turn))[0];
        EXPECT_GT(least, 0.7 * kRadius) << slant << ' ' << is_round << ' ' << turn;
      }
    }
  }
}

// Within a flat limb, too. Its radius is the same in the corner.
TEST(CutLimbs, ThatAreFlatAndCutAtASlantEndInTheirMiddle) {
  constexpr double kThick = 6, kWide = 20, kHalfLength = 90;
  const double tangent = std::tan(20 * std::numbers::pi / 180);
  const auto bar = [&](const WorldPoint& p) {
    return std::abs(p[2]) <= kThick && std::abs(p[1]) <= kWide &&
           std::abs(p[0] - tangent * p[1]) <= kHalfLength;
  };
  const auto result = Skeletonize(Sampled(bar, 100, 0), {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->graph.nodes.size(), 2u);
  for (const SkeletonNode& node : result->graph.nodes) {
    EXPECT_LT(std::abs(node.at.point.y - 100), 0.4 * kWide);
  }
}

// Thinning leads the path to the rim of the wide face, which is no limb with a root, and stops far
// from the point.
TEST(CutLimbs, ThatWidenEndInTheLargestBall) {
  constexpr double kRadius = 40, kLength = 80, kBlunt = 4;
  // The hull of two balls, cut through the middle of the larger one.
  const double steep = (kRadius - kBlunt) / kLength, flat = std::sqrt(1 - steep * steep);
  const auto cone = [&](const WorldPoint& p) {
    const double along = p[0] + kLength / 2, across = std::hypot(p[1], p[2]);
    const double t = std::clamp((along - across * steep / flat) / kLength, 0.0, 1.0);
    const double radius = kRadius + t * (kBlunt - kRadius);
    return along >= 0 && std::hypot(along - t * kLength, across) <= radius;
  };
  for (const double turn : {0.4, 0.6, 1.3, 1.5}) {
    const auto [least, most] = EndRadiiOf(Sampled(cone, 60, turn));
    EXPECT_GT(most, 0.6 * kRadius) << turn;
    EXPECT_LT(least, 1.6 * kBlunt) << turn;
  }
}

}  // namespace
}  // namespace bccskel
