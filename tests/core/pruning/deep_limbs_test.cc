// Limbs that are deeper than wide and cut square, such as the teeth of a gear: thinning may end
// their curves half the depth before the rim.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

int64_t EndsWhere(const std::function<bool(const WorldPoint&)>& solid, int32_t cells, double turn) {
  const auto result = Skeletonize(test::Sampled(solid, cells, turn), {}, {});
  EXPECT_TRUE(result.ok()) << result.status();
  if (!result.ok()) return -1;
  return std::ranges::count(result->graph.nodes, NodeKind::kEnd, &SkeletonNode::kind);
}

// In lattice units.
struct Gear {
  int teeth = 8;
  double root = 40, bore = 15, thickness = 30, width = 20, height = 22.5;

  bool Contains(const WorldPoint& p) const {
    if (std::abs(p[2]) > thickness / 2) return false;
    const double out = std::hypot(p[0], p[1]);
    if (out <= root) return out >= bore;
    const double pitch = 2 * std::numbers::pi / teeth;
    const double turn = std::remainder(std::atan2(p[1], p[0]), pitch);
    return out * std::cos(turn) <= root + height && std::abs(out * std::sin(turn)) <= width / 2;
  }
};

TEST(DeepLimbs, AreTheTeethOfAGearInAnyPose) {
  for (const Gear& gear :
       {Gear{}, Gear{.thickness = 50, .height = 40}, Gear{12, 63, 22, 35, 18, 25}}) {
    for (const double turn : {0.0, 0.4, 1.1}) {
      EXPECT_EQ(EndsWhere([&](const WorldPoint& p) { return gear.Contains(p); }, 95, turn),
                gear.teeth)
          << turn;
    }
  }
}

// The upright of a T is as deep as its bar.
TEST(DeepLimbs, AreTheUprightsOfBarsWhateverTheirWidth) {
  constexpr double kDepth = 32, kHeight = 28;
  for (const double width : {6, 10, 16, 32}) {
    const auto solid = [&](const WorldPoint& p) {
      if (std::abs(p[2]) > kDepth / 2) return false;
      const bool in_bar = std::abs(p[0]) <= 80 && std::abs(p[1]) <= kDepth / 2;
      return in_bar || (std::abs(p[0]) <= width / 2 && p[1] > 0 && p[1] <= kDepth / 2 + kHeight);
    };
    for (const double turn : {0.0, 0.4}) EXPECT_EQ(EndsWhere(solid, 90, turn), 3) << width;
  }
}

}  // namespace
}  // namespace bccskel
