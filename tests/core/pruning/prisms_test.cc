// Rods with sharp edges, cut square. The curve forks into the corners of a face, and the branch
// that stays does not show where the rod ends.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/sampled.h"

namespace bccskel {
namespace {

constexpr double kInscribed = 11, kHalfLength = 70;  // of the inscribed circle; lattice units

// Where they are sharper, sampling makes loops of the edges.
bool IsBlunt(double y, double z) { return std::hypot(y, z) <= 1.85 * kInscribed; }

bool InTriangle(double y, double z) {
  return IsBlunt(y, z) && y <= kInscribed && -y / 2 + std::abs(z) * std::sqrt(0.75) <= kInscribed;
}

bool InHalfDisc(double y, double z) {
  return y >= -kInscribed && std::hypot(y + kInscribed, z) <= 2 * kInscribed;
}

bool InRhombus(double y, double z) {
  return IsBlunt(y, z) && std::abs(y) <= kInscribed &&
         std::abs(y / 2 + z * std::sqrt(0.75)) <= kInscribed;
}

TEST(Prisms, EndOnTheirAxes) {
  constexpr int32_t kCells = 80;
  for (const auto in_section : {InTriangle, InHalfDisc, InRhombus}) {
    const auto solid = [&](const WorldPoint& p) {
      return std::abs(p[0]) <= kHalfLength && in_section(p[1], p[2]);
    };
    for (const double turn : {0.1, 0.3, 0.5, 0.7, 0.9, 1.1, 1.3, 1.5}) {
      SCOPED_TRACE(turn);
      const auto result = Skeletonize(test::Sampled(solid, kCells, turn), {}, {});
      ASSERT_TRUE(result.ok()) << result.status();
      int ends = 0;
      for (const SkeletonNode& node : result->graph.nodes) {
        if (node.kind != NodeKind::kEnd) continue;
        ++ends;
        const WorldPoint end = test::InFrame(node.at.point, kCells, turn);
        EXPECT_LT(std::hypot(end[1], end[2]), 0.7 * kInscribed) << "at " << end[0];
      }
      EXPECT_EQ(ends, 2);
    }
  }
}

}  // namespace
}  // namespace bccskel
