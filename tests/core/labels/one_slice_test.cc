// Images of one slice against the figures that they are drawings of.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "core/skeleton/skeleton_figures.h"
#include "tests/core/labels/voxel_figure.h"

namespace bccskel {
namespace {

using test::SkeletonOf, test::Voxel;

// With round ends around those of its middle line.
struct Rod {
  double width = 1;
  double degrees = 0;
};

constexpr double kLength = 200;
constexpr int32_t kEdge = 224;

// In a square image across `axis`.
struct Picture {
  size_t axis = 2;
  double thickness = 1;  // of the slice
  MaskOptions mask = {};

  SkeletonizeResult Of(const Rod& rod) const {
    std::array<int32_t, 3> voxels = {kEdge, kEdge, kEdge};
    voxels[axis] = 1;
    MaskGrid grid = {.nx = voxels[0], .ny = voxels[1], .nz = voxels[2]};
    grid.placement.spacing[axis] = thickness;
    const double angle = rod.degrees * std::numbers::pi / 180;
    return SkeletonOf(grid, {}, mask, [&](const Voxel& at) {
      const double u = at[(axis + 1) % 3] - kEdge / 2.0, v = at[(axis + 2) % 3] - kEdge / 2.0;
      const double along = u * std::cos(angle) + v * std::sin(angle);
      const double across = v * std::cos(angle) - u * std::sin(angle);
      const double beyond = std::max(std::abs(along) - kLength / 2, 0.0);
      const double half = std::sqrt(std::max(rod.width * rod.width / 4 - beyond * beyond, 0.0));
      return across >= -half && across < half;
    });
  }
};

void ExpectLengthAndRadiusOf(const Rod& rod, const Picture& picture) {
  SCOPED_TRACE(testing::Message() << rod.width << " wide at " << rod.degrees << " degrees, along "
                                  << picture.axis << ", slice of " << picture.thickness);
  const SkeletonGraph graph = picture.Of(rod).graph;
  ASSERT_EQ(graph.edges.size(), 1u);
  const EdgeFigures figures = FiguresOf(graph, graph.edges.front());
  // A line of single pixels is a staircase that smoothing does not level.
  EXPECT_NEAR(figures.length / kLength, 1, rod.width == 1 ? 0.04 : 0.03);
  EXPECT_NEAR(figures.mean_radius, rod.width / 2, 0.6);
  const std::array<size_t, 2> axes = {(picture.axis + 1) % 3, (picture.axis + 2) % 3};
  for (const SkeletonPoint& p : graph.points) {
    const WorldPoint at = graph.PositionOf(p);
    const double out = std::hypot(at[axes[0]] - kEdge / 2.0, at[axes[1]] - kEdge / 2.0);
    if (out > kLength / 2 - rod.width - 2) continue;
    ASSERT_NEAR(graph.RadiusOf(p), rod.width / 2, 0.7);  // to the corners of pixels in places
  }
}

TEST(OneSlice, RodsHaveTheirLengthAndRadius) {
  for (const double width : {1.0, 2.0, 3.0, 5.0, 9.0}) {
    for (const double degrees : {0.0, 7.0, 20.0, 33.0, 45.0, 61.0, 90.0}) {
      ExpectLengthAndRadiusOf({width, degrees}, {});
    }
  }
}

TEST(OneSlice, RodsHaveTheirLengthAndRadiusAlongAnyAxisHoweverThickTheSlice) {
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const double thickness : {0.3, 1.0, 2.0, 8.0}) {
      for (const double width : {2.0, 9.0}) {
        ExpectLengthAndRadiusOf({width, 20}, {axis, thickness});
      }
    }
    ExpectLengthAndRadiusOf({5, 33}, {axis, 1, {.points = VoxelPoints::kSixteen}});
    ExpectLengthAndRadiusOf({5, 33}, {axis, 1, {.sampling = MaskSamplingOptions{}}});
  }
}

// The surface of the object is flat across the slice, however thin that is.
TEST(OneSlice, StraightBarsHaveExactRadii) {
  for (const double width : {2.0, 3.0, 4.0, 6.0, 10.0, 20.0}) {
    const SkeletonGraph graph = Picture{}.Of({width, 0}).graph;
    for (const SkeletonPoint& p : graph.points) {
      const double out = std::abs(graph.PositionOf(p)[0] - kEdge / 2.0);
      if (out > kLength / 2 - width - 2) continue;
      ASSERT_NEAR(graph.RadiusOf(p), width / 2, 0.01);
    }
  }
}

// Along the image's left and upper border, and cut off at its right one.
TEST(OneSlice, EndsAtItsOtherFacesUnlessTheyContinueToo) {
  const MaskGrid grid = {.nx = 120, .ny = 60, .nz = 1};
  const auto bar = [](const Voxel& at) { return at[1] < 10; };
  const auto radius_of = [&](Border border) {
    const SkeletonGraph graph = SkeletonOf(grid, {.border = border}, {}, bar).graph;
    double most = 0;
    for (const SkeletonPoint& p : graph.points) most = std::max(most, graph.RadiusOf(p));
    return most;
  };
  EXPECT_NEAR(radius_of(Border::kEnds), 5, 0.6);
  EXPECT_NEAR(radius_of(Border::kContinues), 10, 0.6);
}

// Where all continues, nothing ends it but the image.
TEST(OneSlice, FullOfTheObjectEndsAtTheOtherFaces) {
  const MaskGrid grid = {.nx = 90, .ny = 40, .nz = 1};
  for (const Border border : {Border::kEnds, Border::kContinues}) {
    const SkeletonizeResult result =
        SkeletonOf(grid, {.border = border}, {}, [](const Voxel&) { return true; });
    double most = 0;
    for (const SkeletonPoint& p : result.graph.points) {
      most = std::max(most, result.graph.RadiusOf(p));
    }
    EXPECT_NEAR(most, 20, 0.6);
  }
}

TEST(OneSlice, IsStatedByTheResult) {
  const auto right = [](const Voxel& at) { return at[0] > 3; };
  const auto all = [](const Voxel&) { return true; };
  const MaskGrid one = {.nx = 30, .ny = 20, .nz = 1};
  using enum Border;
  for (const Border border : {kAuto, kEnds, kContinuesAcrossSlice}) {
    const SkeletonizeOptions options = {.border = border};
    EXPECT_EQ(SkeletonOf(one, options, {}, right).options.border, kContinuesAcrossSlice);
    const MaskGrid two = {.nx = 30, .ny = 20, .nz = 2}, row = {.nx = 30, .ny = 1, .nz = 1};
    EXPECT_EQ(SkeletonOf(two, options, {}, right).options.border, kEnds);
    EXPECT_EQ(SkeletonOf(row, options, {}, right).options.border, kEnds);
  }
  EXPECT_EQ(SkeletonOf(one, {.border = kContinues}, {}, right).options.border, kContinues);
  EXPECT_EQ(SkeletonOf(one, {.border = kContinues}, {}, all).options.border, kContinuesAcrossSlice);
}

}  // namespace
}  // namespace bccskel
