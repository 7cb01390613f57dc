#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <utility>

#include "core/export/surface/cell_grid.h"
#include "tests/support/contexts.h"
#include "tests/support/enclosed_volume.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

using test::EnclosedBy;

CellGrid GridOf(std::span<const LatticePoint> points, int halvings) {
  CellGrid grid = *CellGrid::Of(VolumeOfPoints(points), {});
  for (int n = 0; n < halvings; ++n) grid = *grid.Halved({});
  return grid;
}

// All odd points of a box: what the exact conversion makes of its voxels, but for their corners.
std::vector<LatticePoint> OddBox(const LatticePoint& low, const LatticePoint& high) {
  std::vector<LatticePoint> points;
  for (int32_t z = low.z | 1; z < high.z; z += 2) {
    for (int32_t y = low.y | 1; y < high.y; y += 2) {
      for (int32_t x = low.x | 1; x < high.x; x += 2) points.push_back({x, y, z});
    }
  }
  return points;
}

void ExpectClosed(const SurfaceMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> surplus;
  for (const auto& [a, b, c] : mesh.triangles) {
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, c), std::pair(c, a)}) {
      ++surplus[{from, to}];
      --surplus[{to, from}];
    }
  }
  for (const auto& [edge, count] : surplus) EXPECT_EQ(count, 0);
}

TEST(CellSurfaceTest, AnEmptyObjectHasNone) {
  const SurfaceMesh mesh = *ExtractCellSurface(GridOf({}, 1), {});
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(CellSurfaceTest, NoiseIsClosedAtEveryWidth) {
  for (int halvings = 0; halvings < 4; ++halvings) {
    const auto points = test::RandomCloud(7, {40, 22, 20}, 0.1);
    const SurfaceMesh mesh = *ExtractCellSurface(GridOf(points, halvings), {});
    ASSERT_FALSE(mesh.triangles.empty());
    ExpectClosed(mesh);
    EXPECT_GT(EnclosedBy(mesh), 0) << halvings;
  }
}

TEST(CellSurfaceTest, CellsOfFourUnitsAreVoxelsAgainAcrossBricks) {
  const SurfaceMesh mesh = *ExtractCellSurface(GridOf(OddBox({8, 4, 12}, {88, 52, 60}), 1), {});
  // 20 x 12 x 12 voxels.
  EXPECT_EQ(mesh.triangles.size(), 2u * 2 * (20 * 12 + 12 * 12 + 12 * 20));
  for (const SurfaceVertex& v : mesh.vertices) {
    EXPECT_TRUE(v[0] >= 8 && v[0] <= 88 && v[1] >= 4 && v[1] <= 52 && v[2] >= 12 && v[2] <= 60);
  }
  EXPECT_NEAR(EnclosedBy(mesh) / (80 * 48 * 48), 1, 0.03);  // its edges are cut a little
}

TEST(CellSurfaceTest, PartlyFullCellsAreCutWhereTheObjectEnds) {
  // Ends in the middle of cells of 8 units.
  const SurfaceMesh mesh = *ExtractCellSurface(GridOf(OddBox({4, 4, 4}, {124, 124, 124}), 2), {});
  EXPECT_NEAR(EnclosedBy(mesh) / std::pow(120, 3), 1, 0.03);
}

TEST(CellSurfaceTest, NothingThinIsLost) {
  const LatticePoint odd[] = {{9, 9, 9}}, even[] = {{8, 8, 8}}, both[] = {{8, 8, 8}, {9, 9, 9}};
  const auto triangles = [](std::span<const LatticePoint> points, int halvings) {
    return ExtractCellSurface(GridOf(points, halvings), {})->triangles.size();
  };
  for (int halvings = 0; halvings < 5; ++halvings) {
    EXPECT_EQ(triangles(odd, halvings), 12u) << halvings;
    EXPECT_EQ(triangles(even, halvings), 12u) << halvings;
    EXPECT_EQ(triangles(both, halvings), 12u) << halvings;
  }
}

TEST(CellSurfaceTest, EvenPointsCountOnlyWithoutOddNeighbors) {
  const LatticePoint below[] = {{16, 8, 8}, {15, 7, 7}};  // neighbors in two bricks
  EXPECT_EQ(ExtractCellSurface(GridOf(below, 0), {})->triangles.size(), 12u);
}

TEST(CellSurfaceTest, TheEstimateIsAboutRight) {
  const auto points = test::RandomBlob(3, {60, 60, 60}, 5, 25);
  for (int halvings = 0; halvings < 3; ++halvings) {
    const CellGrid grid = GridOf(points, halvings);
    const auto triangles = static_cast<double>(ExtractCellSurface(grid, {})->triangles.size());
    EXPECT_NEAR(grid.TriangleEstimate() / triangles, 1, 0.25) << halvings;
  }
}

TEST(CellSurfaceTest, StopsWhenItIsToldTo) {
  const exec::Context context = test::Stopped();
  EXPECT_EQ(ExtractCellSurface(GridOf(OddBox({0, 0, 0}, {8, 8, 8}), 0), context).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel
