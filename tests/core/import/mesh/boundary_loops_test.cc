#include "core/import/mesh/boundary_loops.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "tests/core/import/mesh/mesh_shapes.h"

namespace bccskel {
namespace {

using Loops = std::vector<std::vector<uint32_t>>;

Loops LoopsOf(const TriangleMesh& mesh) {
  return BoundaryLoops(SortedSides(mesh.triangles), mesh.vertices.size());
}

// How often the triangles pass each edge upward less how often downward.
std::map<std::pair<uint32_t, uint32_t>, int> Surplus(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> surplus;
  for (const TriangleMesh::Triangle& t : mesh.triangles) {
    for (size_t n = 0; n < 3; ++n) {
      const uint32_t a = t[n], b = t[(n + 1) % 3];
      surplus[std::minmax(a, b)] += a < b ? 1 : -1;
    }
  }
  std::erase_if(surplus, [](const auto& edge) { return edge.second == 0; });
  return surplus;
}

TriangleMesh Closed(TriangleMesh mesh) {
  for (const TriangleMesh::Triangle& cap : CapsOf(LoopsOf(mesh))) mesh.triangles.push_back(cap);
  return mesh;
}

TEST(BoundaryLoops, OfAClosedSurfaceAreNone) { EXPECT_TRUE(LoopsOf(testing::Torus(5, 1)).empty()); }

TEST(BoundaryLoops, PassAHoleAgainstTheSurface) {
  TriangleMesh mesh = testing::Box({0, 0, 0}, {1, 1, 1});
  const TriangleMesh::Triangle missing = mesh.triangles.back();
  mesh.triangles.pop_back();
  const Loops loops = LoopsOf(mesh);
  ASSERT_EQ(loops.size(), 1u);
  std::vector<uint32_t> loop = loops[0];
  std::rotate(loop.begin(), std::ranges::find(loop, missing[0]), loop.end());
  EXPECT_THAT(loop, ::testing::ElementsAreArray(missing));
  EXPECT_TRUE(Surplus(Closed(mesh)).empty());
}

// Two holes that touch at a vertex, and an edge of three triangles.
TEST(BoundaryLoops, AreSimpleAndCloseAnySurface) {
  TriangleMesh mesh = testing::Sphere({0, 0, 0}, 1);
  const TriangleMesh::Triangle first = mesh.triangles[40];
  std::erase_if(mesh.triangles, [&](const TriangleMesh::Triangle& t) {
    const auto shared = std::ranges::count_if(
        t, [&](uint32_t v) { return std::ranges::find(first, v) != first.end(); });
    return shared == 3 || (shared == 1 && t[0] % 2 == 0);
  });
  const auto fin = static_cast<uint32_t>(mesh.vertices.size());
  mesh.vertices.push_back({3, 0, 0});
  mesh.triangles.push_back({mesh.triangles[5][0], mesh.triangles[5][1], fin});
  const Loops loops = LoopsOf(mesh);
  EXPECT_GT(loops.size(), 2u);
  for (std::vector<uint32_t> loop : loops) {
    EXPECT_GE(loop.size(), 3u);
    std::ranges::sort(loop);
    EXPECT_EQ(std::ranges::adjacent_find(loop), loop.end());
  }
  EXPECT_FALSE(Surplus(mesh).empty());
  EXPECT_TRUE(Surplus(Closed(mesh)).empty());
}

}  // namespace
}  // namespace bccskel
