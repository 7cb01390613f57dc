// Legs that spread from a body are not the corners of the square end of a strip.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::Joined;
using test::ToLimb;

// A body with a head and two legs that stick out forward and to both sides. The line from one foot
// to the other lies in the body, and across the pelvis the legs make it wide.
struct Sitter {
  double body, tall, spread, down, leg, length, fillet, turn, low;

  WorldPoint Foot(int side) const {
    const double forward = length * std::cos(spread);
    return {side * length * std::sin(spread), -low - forward * std::sin(down),
            forward * std::cos(down)};
  }
  bool Contains(const WorldPoint& p) const {
    double distance = std::sqrt(p[0] * p[0] + p[1] * p[1] / tall / tall + p[2] * p[2]) - body;
    for (const int side : {-1, 1}) {
      const double to_leg = ToLimb(p, {0, -low, 0}, 0.8 * leg, Foot(side), leg);
      distance = Joined(distance, to_leg, fillet);
    }
    return Joined(distance, ToLimb(p, {0, 0, 0}, 12, {0, 1.9 * body, 0}, 14), fillet) <= 0;
  }
};

TEST(SpreadLegs, StayBoth) {
  constexpr int32_t kCells = 96;
  const Sitter sitters[] = {{29.93, 1.56, 1.364, 1.024, 17.43, 46.79, 15.98, 1.166, 14.32},
                            {29.30, 1.54, 1.293, 0.442, 15.17, 43.99, 21.69, 1.263, 6.10},
                            {26.11, 1.53, 1.227, 0.402, 15.34, 46.58, 19.25, 2.048, 7.53},
                            {28.45, 1.41, 1.227, 0.492, 15.27, 44.52, 17.67, 1.513, 13.68},
                            {28.45, 1.70, 1.337, 1.164, 15.91, 44.60, 16.52, 2.563, 13.83}};
  for (const Sitter& sitter : sitters) {
    SCOPED_TRACE(sitter.body);
    const auto solid = [&](const WorldPoint& p) { return sitter.Contains(p); };
    const auto result = Skeletonize(test::Sampled(solid, kCells, sitter.turn), {}, {});
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 3);
    for (const int side : {-1, 1}) {
      EXPECT_LT(GapAt(sitter.Foot(side), result->graph, kCells, sitter.turn), 1.3 * sitter.leg);
    }
  }
}

}  // namespace
}  // namespace bccskel
