// Pipes: across a branch along their wall, the object surrounds a hollow.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

struct Tee {
  double radius, wall, length;

  // Two pipes that meet at a right angle, open at their three ends.
  bool Contains(const WorldPoint& p) const {
    const double to_run = std::hypot(p[1], p[2]), to_branch = std::hypot(p[0], p[2]);
    const bool in_run = std::abs(p[0]) <= length && to_run <= radius;
    const bool in_branch = p[1] >= 0 && p[1] <= length && to_branch <= radius;
    const bool in_hollow = to_run <= radius - wall || (p[1] >= 0 && to_branch <= radius - wall);
    return (in_run || in_branch) && !in_hollow;
  }
};

int64_t EndsOf(const std::function<bool(const WorldPoint&)>& contains, int32_t cells, double turn) {
  const auto result = Skeletonize(test::Sampled(contains, cells, turn), {}, {});
  if (!result.ok()) return -1;
  return std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
}

TEST(TubeWall, TeesHaveNoEnds) {
  for (const Tee& tee : {Tee{12, 4, 45}, Tee{14, 4, 56}}) {
    const auto cells = static_cast<int32_t>(tee.length + tee.radius);
    for (const double turn : {0.4, 1.0, 2.5}) {
      const auto solid = [&](const WorldPoint& p) { return tee.Contains(p); };
      EXPECT_EQ(EndsOf(solid, cells, turn), 0) << tee.radius << ' ' << turn;
    }
  }
}

// Three rods continue the wall of a pipe beyond its rim.
TEST(TubeWall, RodsThatLeaveAPipeStay) {
  constexpr int32_t kCells = 90;
  const auto solid = [](const WorldPoint& p) {
    const double to_axis = std::hypot(p[1], p[2]);
    bool in = std::abs(p[0] + 20) <= 40 && to_axis <= 20 && to_axis >= 15;
    for (const double angle : {0.0, 2.1, 4.2}) {
      const double y = 17.5 * std::cos(angle), z = 17.5 * std::sin(angle);
      in = in || test::ToLimb(p, {0, y, z}, 4, {76, y, z}, 4) <= 0;
    }
    return in;
  };
  for (const double turn : {0.4, 1.0, 2.5}) EXPECT_EQ(EndsOf(solid, kCells, turn), 3) << turn;
}

}  // namespace
}  // namespace bccskel
