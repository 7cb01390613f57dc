#include "core/export/surface/smooth_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

std::vector<LatticePoint> Ball(double radius) {
  const int32_t cells = static_cast<int32_t>(radius) + 2;
  return test::VolumeWhere({cells, cells, cells},
                           [&](int32_t x, int32_t y, int32_t z) {
                             return std::hypot(x - cells, y - cells, z - cells) < radius;
                           })
      .SortedPoints();
}

TEST(SmoothSurfaceTest, NoVertexMovesBeyondItsReach) {
  const auto points = test::RandomCloud(3, {12, 12, 12}, 0.4);
  const SurfaceMesh before = *ExtractSurface(VolumeOfPoints(points), {});
  SurfaceMesh after = before;
  constexpr float kReach = 0.5f;
  SmoothSurface(after, {.steps = 50, .reach = kReach});
  float farthest = 0;
  for (size_t n = 0; n < before.vertices.size(); ++n) {
    const SurfaceVertex &a = before.vertices[n], &b = after.vertices[n];
    farthest = std::max(farthest, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
  }
  EXPECT_LE(farthest, 0.385f * kReach + 1e-5f);
  EXPECT_GT(farthest, 0.35f * kReach);
}

TEST(SmoothSurfaceTest, SomethingIsLeftOfASinglePoint) {
  const LatticePoint point[] = {{4, 4, 4}};
  SurfaceMesh mesh = *ExtractSurface(VolumeOfPoints(point), {});
  SmoothSurface(mesh, {});
  for (const auto& [x, y, z] : mesh.vertices) EXPECT_GT(std::hypot(x - 4, y - 4, z - 4), 0.03f);
}

// How far normals of a ball's surface are from its radii: the largest sine, squared.
float RoughnessOf(const SurfaceMesh& ball, float center) {
  const std::vector<SurfaceVertex> normals = NormalsOf(ball);
  float worst = 0;
  for (size_t n = 0; n < normals.size(); ++n) {
    float along = 0, square = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      const float radius = ball.vertices[n][axis] - center;
      along += radius * normals[n][axis];
      square += radius * radius;
    }
    worst = std::max(worst, 1 - along * std::abs(along) / square);
  }
  return worst;
}

TEST(SmoothSurfaceTest, ABallBecomesRoundAndItsNormalsPointOutward) {
  SurfaceMesh ball = *ExtractSurface(VolumeOfPoints(Ball(20)), {});
  EXPECT_GT(RoughnessOf(ball, 22), 0.2f);
  SmoothSurface(ball, {});
  EXPECT_LT(RoughnessOf(ball, 22), 0.15f);
}

}  // namespace
}  // namespace bccskel
