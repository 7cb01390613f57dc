// Limbs about as tall as they are wide that leave a round trunk: twigs, spines, last branches.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::ToLimb;

constexpr int32_t kTrunkCells = 90;
constexpr double kTwigRadius = 9;

// Three limbs that leave a trunk at 60 degrees; their surface ends so many of their radii beyond
// the trunk's.
struct Twigs {
  double trunk;
  double out;

  std::array<WorldPoint, 3> Tips() const {
    const double along = (trunk + (out - 1) * kTwigRadius) / std::tan(std::acos(0.5));
    const double up = trunk + (out - 1) * kTwigRadius;
    return {{{-55 + along, up, 0}, {-10 + along, -up, 0}, {30 + along, 0, up}}};
  }
  bool Contains(const WorldPoint& p) const {
    double least = ToLimb(p, {-70, 0, 0}, trunk, {70, 0, 0}, trunk);
    const auto tips = Tips();
    const std::array<double, 3> roots = {-55, -10, 30};
    for (size_t n = 0; n < 3; ++n) {
      least = std::min(least, ToLimb(p, {roots[n], 0, 0}, kTwigRadius, tips[n], kTwigRadius));
    }
    return least <= 0;
  }
};

TEST(Trunk, KeepsLimbsAsTallAsTheyAreWide) {
  for (const double trunk : {kTwigRadius, 2 * kTwigRadius}) {
    const Twigs twigs = {trunk, 2.0};
    const auto contains = [&](const WorldPoint& p) { return twigs.Contains(p); };
    for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
      const auto result = Skeletonize(test::Sampled(contains, kTrunkCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      for (const WorldPoint& tip : twigs.Tips()) {
        EXPECT_LT(GapAt(tip, result->graph, kTrunkCells, turn), kTwigRadius / 2)
            << trunk << ' ' << turn;
      }
      EXPECT_EQ(std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 5);
    }
  }
}

TEST(Trunk, HasNoCurveIntoBumps) {
  const Twigs bumps = {2 * kTwigRadius, 1};
  const auto contains = [&](const WorldPoint& p) { return bumps.Contains(p); };
  for (const double turn : {0.0, 0.3, 0.7, 1.1}) {
    const auto result = Skeletonize(test::Sampled(contains, kTrunkCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->graph.nodes.size(), 2u) << turn;
  }
}

}  // namespace
}  // namespace bccskel
