#include "core/pruning/flat_end.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/import/shapes/rasterize.h"
#include "core/import/shapes/solids.h"
#include "core/pipeline/skeletonize.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

using shapes::Block;
using shapes::Vector;

// Lattice units, half of each.
constexpr double kLength = 120, kWidth = 28, kThickness = 4;

// A strip turned about two axes.
Block Strip(double turn, double thickness = kThickness) {
  const double c = std::cos(turn), s = std::sin(turn);
  return {{kLength, kWidth, thickness}, {c, s * c, s * s}, {-s, c * c, c * s}};
}

Vector Middle(const Volume& object) {
  Vector sum;
  double count = 0;
  object.ForEachPoint([&](LatticePoint p) {
    sum = sum + Vector{double(p.x), double(p.y), double(p.z)};
    ++count;
  });
  return (1 / count) * sum;
}

std::vector<Vector> EndsOf(const Volume& object) {
  const SkeletonizeResult result = *Skeletonize(object, {}, {});
  const Vector middle = Middle(object);
  std::vector<Vector> ends;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    const LatticePoint p = node.at.point;
    ends.push_back(Vector{double(p.x), double(p.y), double(p.z)} - middle);
  }
  return ends;
}

// Half a width away from the rim, as the tip of a round limb is a radius away.
TEST(FlatEnd, LiesInTheMiddleOfAStripInAnyPose) {
  for (const double turn : {0.0, 0.25, 0.5, 1.0}) {
    const Block strip = Strip(turn);
    const Volume clean = *shapes::Rasterize({{strip}}, 1);
    for (const double noise : {0.0, 0.02}) {
      SCOPED_TRACE(testing::Message() << turn << ' ' << noise);
      const std::vector<Vector> ends =
          EndsOf(noise > 0 ? test::WithSimpleNoise(clean, noise, 3) : clean);
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) {
        EXPECT_LT(std::abs(Dot(end, strip.second)), 0.4 * kWidth);
        EXPECT_NEAR(std::abs(Dot(end, strip.first)), kLength - kWidth, 0.4 * kWidth);
      }
    }
  }
}

// Half as thick as wide, or a bit more.
TEST(FlatEnd, LiesInTheMiddleOfAThickBar) {
  for (const double thickness : {14.0, 15.5}) {
    for (const double noise : {0.0, 0.05}) {
      SCOPED_TRACE(testing::Message() << thickness << ' ' << noise);
      const Block bar = Strip(0.5, thickness);
      const Volume clean = *shapes::Rasterize({{bar}}, 1);
      const std::vector<Vector> ends =
          EndsOf(noise > 0 ? test::WithSimpleNoise(clean, noise, 3) : clean);
      ASSERT_EQ(ends.size(), 2u);
      for (const Vector& end : ends) EXPECT_LT(std::abs(Dot(end, bar.second)), 0.4 * kWidth);
    }
  }
}

// A strip bent into an arc: its normal turns by a right angle along the way.
TEST(FlatEnd, LiesInTheMiddleOfABentStrip) {
  const double radius = 140, half_angle = 0.7;
  VolumeBuilder builder({100, 80, 50});
  for (int32_t z = 0; z < 100; ++z) {
    for (int32_t y = 0; y < 160; ++y) {
      for (int32_t x = 0; x < 200; ++x) {
        const double u = x - 100, v = y - 20 + radius * std::cos(half_angle);
        const bool inside = std::abs(std::hypot(u, v) - radius) <= kThickness &&
                            std::abs(std::atan2(u, v)) <= half_angle && std::abs(z - 50) <= kWidth;
        if (inside && IsOnLattice({x, y, z})) builder.Add({x, y, z});
      }
    }
  }
  const SkeletonizeResult result = *Skeletonize(*std::move(builder).Build(), {}, {});
  int ends = 0;
  for (const SkeletonNode& node : result.graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    ++ends;
    EXPECT_LT(std::abs(node.at.point.z - 50), 0.3 * kWidth);
  }
  EXPECT_EQ(ends, 2);
}

// Its corners end no limbs.
TEST(FlatEnd, LeavesThePlateItsCorners) {
  const Block plate = {{60, 60, kThickness}, {0.8, 0.6, 0}, {-0.6, 0.8, 0}};
  const std::vector<Vector> ends = EndsOf(*shapes::Rasterize({{plate}}, 1));
  EXPECT_EQ(ends.size(), 4u);
  for (const Vector& end : ends) EXPECT_GT(Length(end), 65);
}

}  // namespace
}  // namespace bccskel
