// Blunt snouts and pointed ears of heads, in which thinning keeps a curve in one pose and none in
// another.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

using test::GapAt;
using test::Joined;
using test::ToLimb;

constexpr int32_t kCells = 112;

// A neck, a head, a snout that is blunt and thinner than the head, and two pointed ears.
struct Head {
  double head, snout, blunt, ear, root, spread, fillet, turn;

  WorldPoint Snout() const { return {0, -0.2 * head, head * (snout + blunt)}; }
  WorldPoint Ear(int side) const {
    return {side * std::sin(spread) * ear * head, std::cos(spread) * ear * head, 0.1 * head};
  }
  bool Contains(const WorldPoint& p) const {
    double distance = ToLimb(p, {0, 0, -100}, 0.9 * head, {0, 0, -50}, 0.9 * head);
    distance = Joined(distance, ToLimb(p, {0, 0, -50}, 0.8 * head, {0, 0, 0}, head), fillet);
    const WorldPoint to = {0, -0.2 * head, head * snout};
    distance = Joined(distance, ToLimb(p, {0, 0, 0}, 0.7 * head, to, blunt * head), fillet);
    for (const int side : {-1, 1}) {
      const WorldPoint tip = Ear(side), from = {0.4 * tip[0], 0.4 * tip[1], 0.4 * tip[2]};
      const double to_ear = ToLimb(p, from, root * head, tip, 0.06 * head);
      distance = Joined(distance, to_ear, fillet / 2);
    }
    return distance <= 0;
  }
};

// Expects an end in the neck, the snout and each ear, and no other.
void ExpectFourEnds(const Head& head) {
  const auto solid = [&](const WorldPoint& p) { return head.Contains(p); };
  const auto result = Skeletonize(test::Sampled(solid, kCells, head.turn), {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 4);
  const auto gap_at = [&](const WorldPoint& p) {
    return GapAt(p, result->graph, kCells, head.turn);
  };
  EXPECT_LT(gap_at(head.Snout()), 0.7 * head.head);
  for (const int side : {-1, 1}) EXPECT_LT(gap_at(head.Ear(side)), 0.2 * head.head);
}

TEST(MissedLimbs, SnoutsAndEarsThatThinningLeavesOut) {
  const Head heads[] = {{29.84, 1.020, 0.524, 2.165, 0.493, 0.647, 10.91, 1.622},
                        {32.86, 0.914, 0.669, 2.027, 0.400, 0.841, 19.25, 0.035},
                        {34.21, 0.869, 0.682, 1.748, 0.454, 0.848, 18.87, 0.724},
                        {35.52, 0.908, 0.569, 1.877, 0.557, 0.616, 16.73, 2.348},
                        {45.38, 0.963, 0.625, 2.098, 0.370, 0.885, 26.29, 2.160}};
  for (const Head& head : heads) {
    SCOPED_TRACE(head.head);
    ExpectFourEnds(head);
  }
}

// Where a snout flares toward the head, the radius rises toward the head and not along the snout.
TEST(MissedLimbs, TipsOfSnoutsDoNotGoBackIntoTheHead) {
  const Head heads[] = {{42.37, 1.046, 0.486, 1.589, 0.422, 0.875, 18.63, 0.941},
                        {39.59, 1.055, 0.598, 2.050, 0.310, 0.666, 21.88, 2.905},
                        {45.49, 1.074, 0.510, 2.198, 0.322, 0.480, 13.48, 2.459}};
  for (const Head& head : heads) {
    SCOPED_TRACE(head.head);
    ExpectFourEnds(head);
  }
}

// Noise makes the corners of a bar, across which it is triangular, seem round.
TEST(MissedLimbs, CornersOfBarsAreNone) {
  const auto bar = [](const WorldPoint& p) {
    return std::abs(p[0]) <= 100 && std::abs(p[1]) <= 18 && std::abs(p[2]) <= 18;
  };
  const ThinningOptions thinning = {.method = ThinningMethod::kDirectionalAlternating};
  for (const double turn : {0.3, 1.1}) {
    for (const uint64_t seed : {1u, 2u, 3u}) {
      const Volume object = test::WithSimpleNoise(test::Sampled(bar, kCells, turn), 0.05, seed);
      const auto result = Skeletonize(object, {.thinning = thinning}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      EXPECT_EQ(std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 2)
          << turn << ' ' << seed;
    }
  }
}

}  // namespace
}  // namespace bccskel
