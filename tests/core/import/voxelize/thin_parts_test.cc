// Fins, walls and blades thinner than the lattice: whole in every pose, and nothing else changes.
#include "core/import/voxelize/thin_parts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "core/exec/worker_team.h"
#include "core/lattice/directions.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/voxelize/voxelized.h"

namespace bccskel {
namespace {

using test::Voxelized;
using testing::Box;
using ::testing::HasSubstr;
using testing::Merged;
using testing::Turned;

constexpr double kSpacing = 0.1;
constexpr double kUnit = kSpacing / 2;

VoxelizeResult Sampled(const TriangleMesh& mesh) {
  return Voxelized(
      mesh,
      {.spacing = kSpacing, .thin_parts = ThinParts::kSample, .topology = TopologyCheck::kSkip});
}

// Without repairs.
VoxelizeResult Kept(const TriangleMesh& mesh) {
  return Voxelized(mesh, {.spacing = kSpacing, .topology = TopologyCheck::kSkip});
}

BettiNumbers TopologyOf(const VoxelizeResult& result) {
  return CountBettiNumbers(result.volume, {}).value();
}

TriangleMesh Plate(double thickness) {
  return Box({-1.5, -1, -thickness / 2}, {1.5, 1, thickness / 2});
}

TEST(ThinParts, PlatesOfAnyThicknessAreWholeInEveryPose) {
  std::mt19937 random(1);
  int broken = 0;
  for (double thickness = 0.1; thickness < 2; thickness += 0.1) {
    for (int pose = 0; pose < 4; ++pose) {
      const TriangleMesh mesh = Turned(Plate(thickness * kUnit), random);
      EXPECT_EQ(TopologyOf(Kept(mesh)), (BettiNumbers{1, 0, 0})) << thickness;
      broken += TopologyOf(Sampled(mesh)) != BettiNumbers{1, 0, 0};
    }
  }
  EXPECT_GE(broken, 40);  // of 76, or the test shows nothing
}

TEST(ThinParts, PlatesAlongTheAxesAreWholeWhereverTheyLie) {
  for (const double off : {0.0, 0.2, 0.5, 0.9, 1.0, 1.3}) {
    for (size_t axis = 0; axis < 3; ++axis) {
      testing::Vertex low = {0, 0, 0}, high = {2, 2, 2};
      low[axis] = 1 + off * kUnit, high[axis] = low[axis] + 0.3 * kUnit;
      // The block makes the grid the same for all plates.
      const TriangleMesh mesh = Merged(Box(low, high), Box({0, 0, 4}, {2, 2, 5}));
      EXPECT_EQ(TopologyOf(Kept(mesh)), (BettiNumbers{2, 0, 0})) << off << " along " << axis;
    }
  }
}

TEST(ThinParts, ShellsKeepTheirCavity) {
  for (const double wall : {0.2, 0.7, 1.3, 1.9}) {
    const TriangleMesh mesh =
        Merged(testing::Sphere({0, 0, 0}, 1, 60),
               testing::Flipped(testing::Sphere({0, 0, 0}, 1 - wall * kUnit, 60)));
    EXPECT_EQ(TopologyOf(Kept(mesh)), (BettiNumbers{1, 0, 1})) << wall;
    EXPECT_NE(TopologyOf(Sampled(mesh)), (BettiNumbers{1, 0, 1})) << wall;
  }
}

TEST(ThinParts, BladesNeedNoRepair) {
  std::mt19937 random(2);
  int broken = 0;
  for (int n = 0; n < 24; ++n) {
    const TriangleMesh mesh = Turned(testing::Blade(0.2 + 0.05 * (n % 4)), random);
    EXPECT_EQ(TopologyOf(Kept(mesh)), (BettiNumbers{1, 0, 0}));
    broken += TopologyOf(Sampled(mesh)) != BettiNumbers{1, 0, 0};
  }
  EXPECT_GE(broken, 8);
}

TEST(ThinParts, AddsPointsWithinOneUnitOfTheMiddleAndTakesNone) {
  // The middle plane of a plate, turned with it: two directions in the plane as a triangle.
  std::mt19937 random(3);
  for (int pose = 0; pose < 8; ++pose) {
    const TriangleMesh mesh = Turned(Plate(0.8 * kUnit), random);
    const auto& v = mesh.vertices;
    const auto side = [&](size_t a, size_t b) {
      return WorldPoint{v[b][0] - v[a][0], v[b][1] - v[a][1], v[b][2] - v[a][2]};
    };
    const WorldPoint normal = Cross(side(0, 1), side(0, 2));
    const double length = std::sqrt(Dot(normal, normal));
    const VoxelizeResult kept = Kept(mesh), sampled = Sampled(mesh);
    kept.volume.ForEachPoint([&](LatticePoint p) {
      const WorldPoint at = kept.volume.placement().ToWorld(p);
      EXPECT_LE(std::abs(Dot(normal, at)) / length, 1.001 * kUnit);
    });
    sampled.volume.ForEachPoint([&](LatticePoint p) { EXPECT_TRUE(kept.volume.Contains(p)); });
    EXPECT_EQ(kept.added_points, kept.volume.PointCount() - sampled.volume.PointCount());
    EXPECT_EQ(sampled.added_points, 0u);
  }
}

TEST(ThinParts, LeavesThickSolidsAsTheyAre) {
  std::mt19937 random(4);
  for (const TriangleMesh& mesh :
       {testing::Sphere({0, 0, 0}, 1), testing::Torus(2, 0.3), Plate(2.2 * kUnit),
        Merged(testing::Sphere({0, 0, 0}, 1), testing::Sphere({1, 0, 0}, 1))}) {
    const TriangleMesh turned = Turned(mesh, random);
    EXPECT_EQ(Kept(turned).volume, Sampled(turned).volume);
  }
}

// A surface folded onto itself encloses nothing, and parity does not say where the solid is.
TEST(ThinParts, LeavesFoldedSurfacesAndParityAsTheyAre) {
  TriangleMesh folded = Plate(0);
  EXPECT_EQ(Kept(Merged(folded, Box({0, 0, 2}, {1, 1, 3}))).added_points, 0u);
  const VoxelizeResult parity =
      Voxelized(Plate(0.8 * kUnit), {.spacing = kSpacing, .fill = FillRule::kParity});
  EXPECT_EQ(parity.added_points, 0u);
}

TEST(ThinParts, GivesTheSameBitsOnAnyNumberOfThreads) {
  std::mt19937 random(5);
  const TriangleMesh mesh = Turned(Merged(Plate(0.7 * kUnit), testing::Blade(0.2)), random);
  const Volume one = Kept(mesh).volume;
  for (const int threads : {2, 3, 8}) {
    exec::WorkerTeam team(threads);
    exec::Context context;
    context.team = &team;
    const VoxelizeOptions options = {
        .spacing = kSpacing, .axes = LatticeAxes::kWorld, .topology = TopologyCheck::kSkip};
    const auto result = Voxelize(mesh, options, context);
    ASSERT_TRUE(result.ok()) << result.status();
    EXPECT_EQ(result->volume, one);
  }
}

TEST(ThinParts, CountsTowardTheLimitButNotTowardTheNumberAskedFor) {
  std::mt19937 random(7);
  const TriangleMesh mesh =
      Turned(Merged(Plate(0.5 * kUnit), Box({-1, -1, 1}, {1, 1, 1.5})), random);
  const VoxelizeResult asked = Voxelized(mesh, {.points = 20000});
  EXPECT_NEAR(static_cast<double>(asked.volume.PointCount() - asked.added_points), 20000, 400);
  EXPECT_GT(asked.added_points, 500u);
  const auto refused =
      Voxelize(mesh, {.points = 20000, .max_points = asked.volume.PointCount() - 1}, {});
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(refused.status().message(), HasSubstr("lattice points"));
}

// A prism around the z axis from 0 to `length`.
TriangleMesh Needle(double radius, double length, uint32_t sides) {
  TriangleMesh mesh;
  for (const double z : {0.0, length}) {
    for (uint32_t n = 0; n < sides; ++n) {
      const double turn = 2 * std::numbers::pi * n / sides;
      mesh.vertices.push_back({radius * std::cos(turn), radius * std::sin(turn), z});
    }
  }
  for (uint32_t n = 0; n < sides; ++n) {
    const uint32_t next = (n + 1) % sides;
    mesh.triangles.push_back({n, next, n + sides});
    mesh.triangles.push_back({next, next + sides, n + sides});
  }
  for (uint32_t n = 1; n + 1 < sides; ++n) {
    mesh.triangles.push_back({0, n + 1, n});
    mesh.triangles.push_back({sides, sides + n, sides + n + 1});
  }
  return mesh;
}

TEST(ThinParts, NeedlesOfABodyAreWholeToTheirTips) {
  std::mt19937 random(8);
  constexpr double kLength = 3;
  int broken = 0;
  for (const double radius : {0.2, 0.5, 0.8, 1.1}) {
    for (const uint32_t sides : {4u, 7u, 12u}) {
      for (int pose = 0; pose < 4; ++pose) {
        const TriangleMesh mesh = Turned(
            Merged(testing::Sphere({0, 0, 0}, 1), Needle(radius * kUnit, kLength, sides)), random);
        const VoxelizeResult kept = Kept(mesh);
        EXPECT_EQ(TopologyOf(kept), (BettiNumbers{1, 0, 0})) << radius << ' ' << sides;
        double farthest = 0;
        kept.volume.ForEachPoint([&](LatticePoint p) {
          const WorldPoint at = kept.volume.placement().ToWorld(p);
          farthest = std::max(farthest, std::sqrt(Dot(at, at)));
        });
        EXPECT_NEAR(farthest, kLength, 2 * kUnit) << radius << ' ' << sides;
        broken += TopologyOf(Sampled(mesh)) != BettiNumbers{1, 0, 0};
      }
    }
  }
  EXPECT_GE(broken, 16);  // of 48; where nothing is left of the needle, the body is whole
}

TEST(ThinParts, ThinRingsAndKnotsStayClosed) {
  for (const double radius : {0.3, 0.6, 0.9}) {
    EXPECT_EQ(TopologyOf(Kept(testing::Torus(1, radius * kUnit, 90, 9))), (BettiNumbers{1, 1, 0}));
    EXPECT_EQ(TopologyOf(Kept(testing::TrefoilTube(radius * kUnit, 400, 8))),
              (BettiNumbers{1, 1, 0}));
  }
}

TEST(ThinParts, PartsSmallerThanACellAreKept) {
  TriangleMesh mesh = Box({0, 0, 0}, {1, 1, 1});
  for (int n = 0; n < 20; ++n) {
    const double at = 2 + 0.437 * n;
    mesh = Merged(mesh, testing::Sphere({at, 0.3 * at, -0.7 * at}, 0.4 * kUnit));
  }
  EXPECT_EQ(TopologyOf(Kept(mesh)), (BettiNumbers{21, 0, 0}));
  EXPECT_LT(TopologyOf(Sampled(mesh)).components, 12);
}

// Slivers as long as the lattice may be, which no row along x crosses.
TEST(ThinParts, MeshesThatTakeFarTooMuchWorkAreRefused) {
  TriangleMesh mesh;
  for (int n = 0; n < 400; ++n) {
    const double at = 0.01 * n;
    mesh = Merged(mesh, Box({0, at, 0}, {1e5, at + 1e-5, 1e-5}));
  }
  const auto refused = Voxelize(mesh, {.spacing = 0.05}, {});
  EXPECT_EQ(refused.status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(refused.status().message(), HasSubstr("choose a larger spacing"));
}

// Why two units: no step between neighbors crosses a slab of that thickness.
TEST(ThinParts, SlabsOfTwoUnitsHaveNoHolesInAnyDirection) {
  std::mt19937 random(6);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 10000; ++n) {
    const WorldPoint way = {normal(random), normal(random), normal(random)};
    double longest = 0;
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      const LatticePoint step = Direction(bit).offset();
      longest = std::max(longest, std::abs(way[0] * step.x + way[1] * step.y + way[2] * step.z));
    }
    EXPECT_LE(longest, 2 * std::sqrt(Dot(way, way)) * (1 + 1e-12));
  }
}

}  // namespace
}  // namespace bccskel
