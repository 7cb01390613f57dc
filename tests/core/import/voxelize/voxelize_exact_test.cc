// The grid against solids that are known otherwise: counted by hand, analytic, or found by an
// independent ray in another direction.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/voxelize/voxelized.h"
#include "tests/core/import/voxelize/winding_reference.h"

namespace bccskel {
namespace {

using test::Agreement;
using test::Compare;
using test::Voxelized;
using test::WithSpacing;
using testing::Box;
using testing::Flipped;
using testing::Merged;
using testing::Vertex;

// The mesh turned by angles that suit no lattice.
TriangleMesh Tilted(TriangleMesh mesh, double angle = 0.7) {
  const double c = std::cos(angle), s = std::sin(angle), t = std::sin(1.1), u = std::cos(1.1);
  for (Vertex& v : mesh.vertices) {
    const double x = c * v[0] - s * v[1], y = s * v[0] + c * v[1];
    v = {u * x - t * v[2], y, t * x + u * v[2]};
  }
  return mesh;
}

void ExpectWhatRaysFind(const TriangleMesh& mesh, double spacing) {
  const VoxelizeResult result = Voxelized(
      mesh,
      {.spacing = spacing, .thin_parts = ThinParts::kSample, .topology = TopologyCheck::kSkip});
  const Agreement agreement = Compare(result.volume, mesh, [&](const WorldPoint& p) {
    return test::CastSkewRay(mesh, p).winding != 0;
  });
  EXPECT_EQ(agreement.different, 0u) << "of " << agreement.points << " points";
  EXPECT_GT(agreement.inside, 100u);
  EXPECT_LT(agreement.inside, agreement.points);
}

// A box whose walls pass through whole layers of lattice points keeps the points on its lower walls
// only: with w whole cells and a half, layers 1..2w+1 of lattice coordinates, the even ones in w
// and the odd ones in w + 1 rows.
TEST(VoxelizeExact, ABoxWithLatticePointsOnItsWallsIsHalfOpen) {
  for (double w : {1.0, 2.0, 5.0}) {
    const VoxelizeResult result = WithSpacing(Box({0, 0, 0}, {w + 0.5, w + 0.5, w + 0.5}), 1);
    const auto even = static_cast<uint64_t>(w), odd = even + 1;
    EXPECT_EQ(result.volume.PointCount(), even * even * even + odd * odd * odd);
    const auto points = result.volume.SortedPoints();
    ASSERT_FALSE(points.empty());
    EXPECT_EQ(points.front(), (LatticePoint{1, 1, 1}));
    const int32_t last = 2 * static_cast<int32_t>(even) + 1;
    EXPECT_EQ(points.back(), (LatticePoint{last, last, last}));
  }
}

TEST(VoxelizeExact, ABoxOfWholeCellsHoldsTwoPointsPerCell) {
  const VoxelizeResult result = WithSpacing(Box({-1, 2, 5}, {3, 8, 12}), 1);
  EXPECT_EQ(result.volume.PointCount(), 2u * 4 * 6 * 7);
}

TEST(VoxelizeExact, BoxesThatShareAWallFillAsOne) {
  const TriangleMesh halves = Merged(Box({0, 0, 0}, {2.25, 5, 5}), Box({2.25, 0, 0}, {5, 5, 5}));
  for (double spacing : {0.5, 0.37}) {
    EXPECT_EQ(WithSpacing(halves, spacing).volume,
              WithSpacing(Box({0, 0, 0}, {5, 5, 5}), spacing).volume);
  }
}

TEST(VoxelizeExact, ABallHasThePointsWithinItsRadius) {
  const double radius = 1;
  const TriangleMesh mesh = testing::Sphere({0, 0, 0}, radius, 200);
  const VoxelizeResult result = WithSpacing(mesh, 0.05);
  const double sagitta = radius * (1 - std::cos(std::numbers::pi / 400)) * 2;
  uint64_t between = 0;
  for (Sublattice s : kSublattices) {
    const LatticeExtent& extent = result.volume.extent();
    for (int32_t n = 0; n < extent.nx * extent.ny * extent.nz; ++n) {
      const LatticePoint p =
          PointAt(s, n % extent.nx, n / extent.nx % extent.ny, n / extent.nx / extent.ny);
      const WorldPoint world = result.volume.placement().ToWorld(p);
      const double r = std::hypot(world[0], world[1], world[2]);
      const bool contained = result.volume.Contains(p);
      EXPECT_TRUE(contained ? r <= radius + 1e-6 : r >= radius - sagitta) << r;
      between += r > radius - sagitta && r < radius ? 1 : 0;
    }
  }
  EXPECT_LT(between, 100u) << "the mesh is too coarse to say anything";
}

TEST(VoxelizeExact, ATorusHasThePointsWithinItsTube) {
  const TriangleMesh mesh = testing::Torus(2, 0.8, 600, 300);
  const VoxelizeResult result = WithSpacing(mesh, 0.1);
  const auto tube_distance = [](const WorldPoint& p) {
    return std::hypot(std::hypot(p[0], p[1]) - 2, p[2]);
  };
  const Agreement agreement =
      Compare(result.volume, {}, [&](const WorldPoint& p) { return tube_distance(p) < 0.8; });
  EXPECT_GT(agreement.inside, 40000u);
  EXPECT_EQ(result.topology, (BettiNumbers{1, 1, 0}));
  result.volume.ForEachPoint([&](LatticePoint p) {
    EXPECT_LT(tube_distance(result.volume.placement().ToWorld(p)), 0.8 + 1e-6);
  });
  EXPECT_LT(agreement.different, agreement.inside / 2000) << "only beside the flat facets";
}

TEST(VoxelizeExact, CurvedSolidsAreWhatRaysInAnotherDirectionFind) {
  ExpectWhatRaysFind(Tilted(testing::Sphere({0, 0, 0}, 1, 9)), 0.11);
  ExpectWhatRaysFind(Tilted(testing::Torus(2, 0.7, 17, 9)), 0.21);
  ExpectWhatRaysFind(testing::TrefoilTube(0.4, 60, 7), 0.33);
}

TEST(VoxelizeExact, BoxesAtAnyAngleAreWhatRaysInAnotherDirectionFind) {
  for (double angle : {0.0, 0.4, 0.7853981633974483, 1.3}) {
    ExpectWhatRaysFind(Tilted(Box({-1, -0.5, -0.3}, {1, 0.5, 0.3}), angle), 0.1);
  }
}

// Thin and flat tetrahedra, many with edges and corners in common, in every position.
TEST(VoxelizeExactLaw, UnionsOfRandomTetrahedraAreWhatRaysInAnotherDirectionFind) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0, 1);
  const auto corner = [&] {
    return Vertex{coordinate(random), coordinate(random), coordinate(random)};
  };
  for (int round = 0; round < 30; ++round) {
    TriangleMesh mesh;
    const Vertex shared = corner();
    for (int n = 0; n < 12; ++n) {
      mesh = Merged(mesh, testing::Tetrahedron(shared, corner(), corner(), corner()));
    }
    ExpectWhatRaysFind(mesh, 0.06);
    const VoxelizeResult turned = WithSpacing(Flipped(mesh), 0.06);
    EXPECT_EQ(turned.volume, WithSpacing(mesh, 0.06).volume) << "normals must not matter";
  }
}

TEST(VoxelizeExactLaw, ParityOfRandomTetrahedraIsWhatRaysInAnotherDirectionFind) {
  std::mt19937 random(4);
  std::uniform_real_distribution<double> coordinate(0, 1);
  const auto corner = [&] {
    return Vertex{coordinate(random), coordinate(random), coordinate(random)};
  };
  for (int round = 0; round < 10; ++round) {
    TriangleMesh mesh;
    for (int n = 0; n < 8; ++n) {
      const auto part = testing::Tetrahedron(corner(), corner(), corner(), corner());
      mesh = Merged(mesh, n % 2 == 0 ? part : Flipped(part));
    }
    const VoxelizeResult result = Voxelized(
        mesh, {.spacing = 0.05, .fill = FillRule::kParity, .topology = TopologyCheck::kSkip});
    const Agreement agreement = Compare(result.volume, mesh, [&](const WorldPoint& p) {
      return test::CastSkewRay(mesh, p).crossings % 2 != 0;
    });
    EXPECT_EQ(agreement.different, 0u);
    EXPECT_GT(agreement.inside, 100u);
  }
}

// All corners on lattice points and edges along lattice rows: every tie there is.
TEST(VoxelizeExactLaw, ABoxCutIntoTetrahedraAtLatticePointsLosesAndDoublesNoPoint) {
  constexpr double kWide = 4.5;  // cells, so that corners fall on lattice points
  const TriangleMesh box = Box({0, 0, 0}, {kWide, kWide, kWide});
  const Volume whole = WithSpacing(box, 1).volume;
  // The six tetrahedra around the diagonal from corner 0 to corner 7.
  const std::vector<std::array<uint32_t, 2>> rest = {{1, 3}, {3, 2}, {2, 6},
                                                     {6, 4}, {4, 5}, {5, 1}};
  uint64_t points = 0;
  TriangleMesh all;
  for (const auto& [a, b] : rest) {
    const auto part =
        testing::Tetrahedron(box.vertices[0], box.vertices[a], box.vertices[b], box.vertices[7]);
    // Each part spans the whole box, so all get the same grid.
    points += WithSpacing(part, 1).volume.PointCount();
    all = Merged(all, part);
  }
  EXPECT_EQ(points, whole.PointCount());
  EXPECT_EQ(WithSpacing(all, 1).volume, whole);
}

// The middle of the grid swaps the sublattices; a mirror alone would not keep the lattice.
TEST(VoxelizeExact, AMeshReflectedInAPointGivesReflectedPoints) {
  const TriangleMesh mesh =
      Tilted(Merged(testing::Torus(2, 0.6, 20, 9), Box({0, 0, 0}, {1, 3, 1})));
  const Volume volume = WithSpacing(mesh, 0.17).volume;
  const Volume other = WithSpacing(testing::Moved(mesh, -1, {0, 0, 0}), 0.17).volume;
  ASSERT_EQ(other.extent(), volume.extent());
  EXPECT_EQ(other.PointCount(), volume.PointCount());
  const LatticeExtent& n = volume.extent();
  const LatticePoint last = {2 * n.nx - 1, 2 * n.ny - 1, 2 * n.nz - 1};
  volume.ForEachPoint([&](LatticePoint p) { EXPECT_TRUE(other.Contains(last - p)); });
}

}  // namespace
}  // namespace bccskel
