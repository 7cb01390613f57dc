// Limbs that the border of an image cuts off.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>

#include "tests/core/labels/voxel_figure.h"

namespace bccskel {
namespace {

using test::SkeletonOf, test::Voxel;

// A straight limb with an elliptic section, through the middle of the image, cut by both faces
// across x. In voxels and radians.
struct Limb {
  double slant = 0, turn = 0;  // of its way, from the normal of the faces and around it
  double radius = 0, width = 0;
  WorldPoint middle = {};

  WorldPoint Way() const {
    return {std::cos(slant), std::sin(slant) * std::cos(turn), std::sin(slant) * std::sin(turn)};
  }
  bool Contains(const Voxel& voxel) const {
    const WorldPoint u = {-std::sin(slant), std::cos(slant) * std::cos(turn),
                          std::cos(slant) * std::sin(turn)};
    const WorldPoint v = {0, -std::sin(turn), std::cos(turn)};
    double across = 0, beside = 0;
    for (size_t a = 0; a < 3; ++a) {
      const double from = voxel[a] + 0.5 - middle[a];
      across += from * u[a];
      beside += from * v[a];
    }
    return std::hypot(across / radius, beside / width) <= 1;
  }
  // Where its axis meets the face at this x; positions are those of the centers of voxels.
  WorldPoint MiddleAt(double x) const {
    const WorldPoint way = Way();
    WorldPoint at;
    for (size_t a = 0; a < 3; ++a) at[a] = middle[a] + (x - middle[0]) / way[0] * way[a] - 0.5;
    return at;
  }
};

double Between(const WorldPoint& a, const WorldPoint& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

MaskGrid ImageAround(Limb& limb) {
  const auto length = static_cast<int32_t>(9 * limb.radius * std::cos(limb.slant));
  const auto beside = static_cast<int32_t>(length * std::tan(limb.slant) +
                                           2 * limb.width / std::cos(limb.slant) + 6);
  limb.middle = {length / 2.0, beside / 2.0 + 0.3, beside / 2.0 - 0.2};
  return {.nx = length, .ny = beside, .nz = beside};
}

TEST(ImageBorder, LimbsThatItCutsOffLeadToTheMiddleOfTheirCut) {
  for (const double width : {1.0, 2.0}) {
    for (const double degrees : {0.0, 25.0, 45.0, 60.0}) {
      for (const double radius : {2.2, 4.0, 7.5}) {
        SCOPED_TRACE(testing::Message() << width << " wide, " << degrees << " degrees, " << radius);
        Limb limb = {.slant = degrees * std::numbers::pi / 180, .turn = 0.7, .radius = radius};
        limb.width = width * radius;
        const MaskGrid grid = ImageAround(limb);
        const SkeletonizeResult result =
            SkeletonOf(grid, {}, {}, [&](const Voxel& at) { return limb.Contains(at); });
        EXPECT_TRUE(result.certificate.TopologyKept());
        ASSERT_EQ(result.graph.nodes.size(), 2u);
        for (const double x : {0.0, static_cast<double>(grid.nx)}) {
          const WorldPoint middle = limb.MiddleAt(x);
          double least = 1e9;
          for (const SkeletonNode& node : result.graph.nodes) {
            least = std::min(least, Between(result.graph.PositionOf(node.at), middle));
          }
          EXPECT_LT(least, 0.5 + 0.15 * radius) << x;
        }
        for (const SkeletonPoint& p : result.graph.points) {
          EXPECT_NEAR(result.graph.RadiusOf(p), radius, 0.5 + 0.15 * radius);
        }
      }
    }
  }
}

// In a picture as well.
TEST(ImageBorder, LimbsOfAPictureLeadToIt) {
  const double slope = std::tan(0.6), radius = 6;
  const MaskGrid grid = {.nx = 90, .ny = 100, .nz = 1};
  const SkeletonizeResult result = SkeletonOf(grid, {}, {}, [&](const Voxel& at) {
    return std::abs(at[1] + 0.5 - 50 - slope * (at[0] + 0.5 - 45)) <= radius / std::cos(0.6);
  });
  ASSERT_EQ(result.graph.nodes.size(), 2u);
  for (const SkeletonNode& node : result.graph.nodes) {
    const WorldPoint at = result.graph.PositionOf(node.at);
    const double x = at[0] < 45 ? -0.5 : 89.5;
    EXPECT_NEAR(at[0], x, 0.6);
    EXPECT_NEAR(at[1], 49.5 + slope * (x - 44.5), 1.2);
    EXPECT_NEAR(result.graph.RadiusOf(node.at), radius, 0.8);
  }
}

// Behind a thin limb that leaves it there, all balls of its end touch the border.
TEST(ImageBorder, ALimbLeadsToItBehindABranch) {
  const MaskGrid grid = {.nx = 70, .ny = 70, .nz = 40};
  const double slope = 0.5, radius = 8;
  const auto axis = [&](double x) { return 22 + slope * (x - 35); };
  using Case = std::pair<double, Border>;
  for (const auto& [beside, border] : {Case{4, Border::kEnds}, Case{7, Border::kEnds},
                                       Case{10, Border::kEnds}, Case{10, Border::kAuto}}) {
    const double branch = 70 - beside;
    const SkeletonizeOptions options = {.border = border};
    const SkeletonizeResult result = SkeletonOf(grid, options, {}, [&](const Voxel& at) {
      const double x = at[0] + 0.5, y = at[1] + 0.5, z = at[2] + 0.5 - 20;
      const double across = (y - axis(x)) / std::hypot(1, slope);
      return std::hypot(across, z) <= radius ||
             (y > axis(x) && y < 66 && std::hypot(x - branch, z) <= 2);
    });
    const WorldPoint middle = {69.5, axis(70) - 0.5, 19.5};
    double least = 1e9;
    for (const SkeletonNode& node : result.graph.nodes) {
      least = std::min(least, Between(result.graph.PositionOf(node.at), middle));
    }
    EXPECT_LT(least, 2.5) << beside;
    EXPECT_EQ(std::ranges::count(result.graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 3);
  }
}

TEST(ImageBorder, ARingThatTouchesItHasNoEnd) {
  for (const double beside : {-3.0, 0.0, 2.0, 5.0}) {
    const SkeletonizeResult result =
        SkeletonOf({.nx = 60, .ny = 60, .nz = 30}, {}, {}, [&](const Voxel& at) {
          const double out = std::hypot(at[0] - 25 - beside, at[1] - 30) - 20;
          return std::hypot(out, at[2] - 15) <= 5;
        });
    EXPECT_EQ(std::ranges::count(result.graph.nodes, NodeKind::kEnd, &SkeletonNode::kind), 0);
    EXPECT_EQ(result.certificate.skeleton.loops, 1);
  }
}

// Tips and bodies that only touch the border, and limbs that end in the image, are as in an image
// with space around them.
TEST(ImageBorder, WhatItDoesNotCutOffStays) {
  const auto is_in = [](double x, double y, double z) {
    const double rod = std::hypot(std::max(std::abs(x - 40) - 30, 0.0), y - 10, z - 10);
    const double flat_rod = std::abs(x - 40) <= 34 ? std::hypot(y - 30, z - 10) : 99;
    const double ball = std::hypot(x - 21, y - 59, z - 20) / 2.0;
    const double on_ball = x > 21 && x < 66 ? std::hypot(y - 59, z - 20) : 99;
    return rod <= 10 || flat_rod <= 6 || ball <= 10 || on_ball <= 5;
  };
  const auto ends_in = [&](int32_t space) {
    const MaskGrid grid = {.nx = 80 + 2 * space, .ny = 80 + 2 * space, .nz = 40 + 2 * space};
    const SkeletonizeResult result = SkeletonOf(grid, {}, {}, [&](const Voxel& at) {
      return is_in(at[0] - space + 0.5, at[1] - space + 0.5, at[2] - space + 0.5);
    });
    std::vector<std::array<double, 4>> ends;
    for (const SkeletonNode& node : result.graph.nodes) {
      const WorldPoint at = result.graph.PositionOf(node.at);
      ends.push_back({at[0] - space, at[1] - space, at[2] - space, node.at.radius});
    }
    std::ranges::sort(ends);
    return ends;
  };
  EXPECT_EQ(ends_in(0), ends_in(3));
}

}  // namespace
}  // namespace bccskel
