#include "client/view/display_surface.h"

#include <gtest/gtest.h>

#include <span>
#include <utility>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/enclosed_volume.h"

namespace bccskel::view {
namespace {

using test::EnclosedBy;

Volume Ball(const Placement& placement = {}) {
  const Volume ball = *GenerateShape(Shape::kBall, {.points = 30000});
  return Volume::FromSortedBricks(ball.extent(), placement,
                                  {ball.keys().begin(), ball.keys().end()},
                                  {ball.bricks().begin(), ball.bricks().end()});
}

TEST(DisplaySurfaceTest, KeepsToItsBudgetAndItsVolume) {
  // Two points to a cubic cell.
  const Volume ball = Ball({.spacing = {3, 3, 3}, .origin = {100, 0, -7}});
  const double volume = 27.0 / 2 * static_cast<double>(ball.PointCount());
  for (const size_t budget : {size_t{1} << 30, size_t{5000}, size_t{500}}) {
    const DisplaySurface surface = *MakeDisplaySurface(ball, budget, {});
    EXPECT_LE(surface.triangles.size(), budget);
    EXPECT_NEAR(EnclosedBy(surface) / volume, 1, 0.05) << budget;
  }
}

TEST(DisplaySurfaceTest, AMirroringPlacementKeepsTheOutsideOutside) {
  const Placement mirror = {.direction = {1, 0, 0, 0, -1, 0, 0, 0, 1}};
  EXPECT_GT(EnclosedBy(*MakeDisplaySurface(Ball(mirror), 1000, {})), 0);
}

TEST(PeelForDisplayTest, LayersShrinkFromTheWholeToTheLastShell) {
  const Peeling peeling = *PeelForDisplay(Ball(), {.layers = 6}, {});
  ASSERT_EQ(peeling.layers.size(), 7u);
  EXPECT_EQ(peeling.layers.front().shells, 0);
  EXPECT_EQ(peeling.layers.back().shells, peeling.last_shell - 1);
  for (size_t n = 1; n < peeling.layers.size(); ++n) {
    EXPECT_GT(peeling.layers[n].shells, peeling.layers[n - 1].shells);
    EXPECT_LT(EnclosedBy(peeling.layers[n].surface), EnclosedBy(peeling.layers[n - 1].surface));
    EXPECT_GT(EnclosedBy(peeling.layers[n].surface), 0);
  }
}

TEST(PeelByShellsTest, ALayerIsWhatGoesLater) {
  const Volume ball = Ball();
  PeeledShells shells;
  const auto keep = [&](int32_t shell, Volume points) { shells[shell] = std::move(points); };
  const SkeletonizeResult result = *Skeletonize(ball, {}, {}, keep);
  const PeelingLimits limits = {.layer_triangles = 1'000'000, .layers = 6};
  const Peeling peeling = *PeelByShells(ball, shells, result.last_shell, limits, {});
  ASSERT_EQ(peeling.layers.size(), 7u);
  EXPECT_EQ(peeling.last_shell, result.last_shell);
  for (const auto& [shells_off, surface] : std::span(peeling.layers).subspan(1)) {
    double points = 0;
    for (const auto& [shell, gone] : shells) {
      if (shell > shells_off) points += static_cast<double>(gone.PointCount());
    }
    // Two points to a cubic cell. The surface of a small rest is smoothed a good deal.
    EXPECT_NEAR(EnclosedBy(surface) * 2, points, 0.25 * points + 60) << shells_off;
  }
}

TEST(PeelForDisplayTest, NothingHasOneEmptyLayer) {
  const Peeling nothing = *PeelForDisplay(VolumeOfPoints({}), {}, {});
  ASSERT_EQ(nothing.layers.size(), 1u);
  EXPECT_TRUE(nothing.layers.front().surface.triangles.empty());
}

}  // namespace
}  // namespace bccskel::view
