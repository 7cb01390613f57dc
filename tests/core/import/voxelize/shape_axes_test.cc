#include "core/import/voxelize/shape_axes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "core/import/voxelize/voxelize.h"
#include "gtest/gtest.h"
#include "tests/core/import/mesh/mesh_shapes.h"

namespace bccskel {
namespace {

using testing::Box;
using testing::Merged;
using testing::Sphere;
using testing::Torus;
using testing::TrefoilTube;

using Axes = std::array<WorldPoint, 3>;

Axes RandomAxes(uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto unit = [](const WorldPoint& v) {
    const double length = std::sqrt(Dot(v, v));
    return WorldPoint{v[0] / length, v[1] / length, v[2] / length};
  };
  const auto any = [&] { return unit({normal(random), normal(random), normal(random)}); };
  const WorldPoint first = any(), third = unit(Cross(first, any()));
  return {first, Cross(third, first), third};
}

// The mesh in another pose: its axes x, y and z become `axes`.
TriangleMesh Posed(TriangleMesh mesh, const Axes& axes, const WorldPoint& moved) {
  for (TriangleMesh::Vertex& vertex : mesh.vertices) {
    const TriangleMesh::Vertex old = vertex;
    for (size_t row = 0; row < 3; ++row) {
      vertex[row] = moved[row];
      for (size_t axis = 0; axis < 3; ++axis) vertex[row] += axes[axis][row] * old[axis];
    }
  }
  return mesh;
}

// No two axes are alike, and no plane is one of symmetry.
TriangleMesh Animal() {
  return Merged(Merged(Sphere({0, 0, 0}, 4), Sphere({7, 1, 0}, 2.5)),
                Merged(Sphere({1, 5, 2}, 1.5), Sphere({-5, 0.5, 1}, 1.2)));
}

std::vector<ShapeAxes> AxesOf(const TriangleMesh& mesh) {
  return ShapeAxesOf(PrepareSurface(mesh));
}

Volume VolumeOf(const TriangleMesh& mesh, LatticeAxes axes) {
  return Voxelize(mesh, {.points = 20000, .axes = axes}, {})->volume;
}

TEST(ShapeAxes, GiveTheSameLatticePointsInEveryPose) {
  const Volume once = VolumeOf(Animal(), LatticeAxes::kShape);
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const TriangleMesh mesh = Posed(Animal(), RandomAxes(seed), {3, -20, 0.7});
    const Volume again = VolumeOf(mesh, LatticeAxes::kShape);
    EXPECT_EQ(again.SortedPoints(), once.SortedPoints()) << seed;
    EXPECT_NE(VolumeOf(mesh, LatticeAxes::kWorld).SortedPoints(), once.SortedPoints()) << seed;
  }
}

TEST(ShapeAxes, KeepPointsWhereTheMeshIs) {
  const TriangleMesh mesh = Posed(Animal(), RandomAxes(8), {3, -20, 0.7});
  const Volume volume = VolumeOf(mesh, LatticeAxes::kShape);
  // The center of the largest ball.
  const WorldPoint center = {3, -20, 0.7};
  WorldPoint mean = {0, 0, 0};
  size_t near = 0;
  volume.ForEachPoint([&](LatticePoint p) {
    const WorldPoint place = volume.placement().ToWorld(p);
    if (DistanceBetween(place, center) > 2.5) return;
    for (size_t n = 0; n < 3; ++n) mean[n] += place[n];
    ++near;
  });
  ASSERT_GT(near, 1000U);
  for (double& m : mean) m /= static_cast<double>(near);
  EXPECT_LT(DistanceBetween(mean, center), 0.05);
}

TEST(ShapeAxes, AreThoseOfFlatFaces) {
  const TriangleMesh part = Merged(Box({0, 0, 0}, {20, 9, 2}), Box({0, 0, 2}, {4, 9, 12}));
  EXPECT_TRUE(AxesOf(part).empty());
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const Axes pose = RandomAxes(seed);
    const std::vector<ShapeAxes> found = AxesOf(Posed(part, pose, {1, 2, 3}));
    ASSERT_FALSE(found.empty());
    const auto& [x, y, z] = found.front().axes;
    for (const WorldPoint& axis : {x, y, z}) {
      const auto along = [&](const WorldPoint& own) { return std::abs(Dot(own, axis)); };
      EXPECT_GT(std::max({along(pose[0]), along(pose[1]), along(pose[2])}), 1 - 1e-9);
    }
    EXPECT_NEAR(Dot(Cross(x, y), z), 1, 1e-12);
  }
}

TEST(ShapeAxes, AreTheWorldsWhereTheShapeHasNone) {
  TriangleMesh open = Animal();
  open.triangles.pop_back();
  EXPECT_TRUE(AxesOf(open).empty());
  EXPECT_TRUE(AxesOf(Sphere({1, 2, 3}, 5)).empty());
  EXPECT_TRUE(AxesOf(Torus(5, 1)).empty());
  EXPECT_TRUE(AxesOf({}).empty());
  EXPECT_TRUE(AxesOf({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}}}).empty());
}

// Two of its axes are arbitrary.
TEST(ShapeAxes, AreRightHandedForASolidOfRevolution) {
  for (uint32_t seed = 1; seed <= 6; ++seed) {
    const auto found = AxesOf(Posed(Torus(5, 1), RandomAxes(seed), {1, 2, 3}));
    ASSERT_FALSE(found.empty());
    for (const ShapeAxes& choice : found) {
      const auto& [x, y, z] = choice.axes;
      EXPECT_NEAR(Dot(Cross(x, y), z), 1, 1e-12);
      for (const WorldPoint& axis : choice.axes) EXPECT_NEAR(Dot(axis, axis), 1, 1e-12);
    }
  }
}

TEST(ShapeAxes, LeaveTheBoxOfTheReportInTheWorld) {
  const TriangleMesh mesh = Posed(Animal(), RandomAxes(4), {0, 0, 0});
  const auto in_world = Voxelize(mesh, {.points = 5000, .axes = LatticeAxes::kWorld}, {});
  const auto own = Voxelize(mesh, {.points = 5000}, {});
  for (size_t n = 0; n < 3; ++n) {
    EXPECT_EQ(own->mesh.lower[n], in_world->mesh.lower[n]);
    EXPECT_EQ(own->mesh.upper[n], in_world->mesh.upper[n]);
  }
}

// Arms of a knot that nearly touch merge along the first axes.
TEST(ShapeAxes, AreFollowedByOthersWhereTheTopologyIsMissed) {
  for (uint32_t seed = 1; seed <= 4; ++seed) {
    const TriangleMesh knot = Posed(TrefoilTube(0.5), RandomAxes(seed), {0, 0, 0});
    const auto result = Voxelize(knot, {.spacing = 0.35}, {});
    EXPECT_EQ(result->topology, (BettiNumbers{1, 1, 0})) << seed;
  }
}

}  // namespace
}  // namespace bccskel
