// Where a limb ends in a fork of two insignificant branches, one of them leads it on.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::ToLimb;

// A stout leg of a body with two arms. It ends in a foot, an ellipsoid that is cut off at a slant.
struct Leg {
  double radius, out;              // in radii of the body
  double deep, wide, high, shift;  // of the foot, in radii of the leg
  double cut, slant;

  bool Contains(const WorldPoint& p) const {
    const double r = radius * kBody, x = At()[0];
    const double body = std::sqrt(p[0] * p[0] + p[1] * p[1] / 1.5 + p[2] * p[2]) - kBody;
    const double leg = ToLimb(p, {0, At()[1], 0}, 1.1 * r, At(), 0.9 * r);
    const double dx = p[0] - x, dy = p[1] - At()[1] - shift * r;
    const double foot = std::hypot(dx / deep, dy / wide, p[2] / high) - r;
    const double far = 2.1 * kBody, up = 0.6 * kBody, thick = 0.3 * kBody;
    const double arms = ToLimb(p, {0, up, -far}, thick, {0, up, far}, thick);
    return std::min({body, arms, std::max(std::min(leg, foot), dx + slant * dy - cut * r)}) <= 0;
  }
  WorldPoint At() const { return {(1 + out) * kBody, -0.4 * kBody, 0}; }

  static constexpr double kBody = 36;
};

TEST(Twins, OfAFootTheOneStaysThatMakesTheLegSignificant) {
  constexpr int32_t kCells = 80;
  const Leg leg = {0.4267, 0.5186, 0.6240, 1.7942, 0.9591, -0.0309, 0.1239, -0.1317};
  const auto solid = [&](const WorldPoint& p) { return leg.Contains(p); };
  for (const double turn : {0.0, 0.3, 0.8, 2.1}) {
    const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 3)
        << turn;
    EXPECT_LT(GapAt(leg.At(), result->graph, kCells, turn), 1.5 * leg.radius * Leg::kBody) << turn;
  }
}

}  // namespace
}  // namespace bccskel
