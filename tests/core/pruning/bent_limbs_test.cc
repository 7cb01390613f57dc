// Tips of limbs that bend as they narrow.
#include <gtest/gtest.h>

#include <cmath>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

// A banana: along an arc of 120 degrees its radius falls to nothing, by up to 0.64 per unit.
TEST(BentLimbs, ThatNarrowToAPointHaveTheirTipsThere) {
  constexpr int32_t kCells = 84;
  constexpr double kArc = 60, kThick = 20, kHalf = 1.0472;
  const auto banana = [](const WorldPoint& p) {
    const double x = p[0] + 0.75 * kArc, far = std::hypot(x, p[1]) - kArc;
    const double along = std::atan2(p[1], x) / kHalf;
    return std::hypot(far, p[2]) <= kThick * (1 - along * along);
  };
  for (const double turn : {0.0, 0.3, 0.8, 1.4, 2.1}) {
    const auto result = Skeletonize(test::Sampled(banana, kCells, turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    ASSERT_EQ(result->graph.nodes.size(), 2u) << turn;
    for (const double side : {-1.0, 1.0}) {
      const WorldPoint point = {-0.25 * kArc, side * kArc * std::sin(kHalf), 0};
      EXPECT_LT(test::GapAt(point, result->graph, kCells, turn), 0.45 * kThick)
          << turn << ' ' << side;
    }
  }
}

}  // namespace
}  // namespace bccskel
