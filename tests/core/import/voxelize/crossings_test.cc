#include "core/import/voxelize/crossings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stop_token>
#include <string>
#include <utility>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/core/import/mesh/test_data.h"

namespace bccskel {
namespace {

using testing::Box;
using testing::Merged;
using testing::Sphere;
using Vertex = TriangleMesh::Vertex;

CrossingCount CountIn(const TriangleMesh& mesh) {
  return *CountCrossings(PrepareSurface(mesh), {});
}
uint64_t CrossingsOf(const TriangleMesh& mesh) { return CountIn(mesh).total(); }

TEST(Crossings, AreNoneWherePartsLieApartOrTouch) {
  EXPECT_EQ(CrossingsOf(Sphere({0, 0, 0}, 1)), 0u);
  EXPECT_EQ(CrossingsOf(Merged(Sphere({0, 0, 0}, 1), Sphere({2.5, 0, 0}, 1))), 0u);
  EXPECT_EQ(CrossingsOf(Merged(Box({0, 0, 0}, {1, 1, 1}), Box({1, 0, 0}, {2, 1, 1}))), 0u);
}

TEST(Crossings, OfANeedleThroughASheetAreThoseOfItsSides) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {1, 1, -4}, {2, 1.1, 4}, {1, 2.2, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(CrossingsOf(mesh), 1u);
  mesh.vertices.push_back({2.1, 2, 6});
  mesh.triangles.push_back({3, 4, 6});  // shares an edge with the other one
  EXPECT_EQ(CrossingsOf(mesh), 2u);
}

TEST(Crossings, OfASurfaceWithItselfAreToldFromThoseOfParts) {
  TriangleMesh mesh;
  mesh.vertices = {{0, 0, 0}, {9, 0, 0}, {0, 9, 0}, {1, 1, -4}, {2, 1.1, 4}, {1, 2.2, 5}};
  mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
  EXPECT_EQ(CountIn(mesh).within_parts, 0u);
  EXPECT_EQ(CountIn(mesh).between_parts, 1u);
  mesh.vertices.push_back({-9, 9, 9});
  mesh.triangles.push_back({2, 5, 6});  // has a vertex of each
  EXPECT_EQ(CountIn(mesh).within_parts, 0u);
  mesh.triangles.insert(mesh.triangles.end(), {{0, 2, 6}, {4, 5, 6}});  // connect them
  EXPECT_EQ(CountIn(mesh).within_parts, 1u);
  EXPECT_EQ(CountIn(mesh).between_parts, 0u);
}

// Whether the segment meets the inside of the triangle, by solving for the place where it does.
bool Meets(const Vertex& p, const Vertex& q, const Vertex& a, const Vertex& b, const Vertex& c) {
  double rows[3][4];
  for (size_t n = 0; n < 3; ++n) {
    rows[n][0] = q[n] - p[n];
    rows[n][1] = a[n] - b[n];
    rows[n][2] = a[n] - c[n];
    rows[n][3] = a[n] - p[n];
  }
  for (size_t k = 0; k < 3; ++k) {
    size_t best = k;
    for (size_t n = k + 1; n < 3; ++n) {
      if (std::abs(rows[n][k]) > std::abs(rows[best][k])) best = n;
    }
    std::swap(rows[k], rows[best]);
    for (size_t n = 0; n < 3; ++n) {
      const double factor = n == k ? 0 : rows[n][k] / rows[k][k];
      for (size_t m = 0; m < 4; ++m) rows[n][m] -= factor * rows[k][m];
    }
  }
  const double along = rows[0][3] / rows[0][0], u = rows[1][3] / rows[1][1],
               v = rows[2][3] / rows[2][2];
  return along > 0 && along < 1 && u > 0 && v > 0 && u + v < 1;
}

TEST(CrossingsLaw, AreThoseOfAllPairs) {
  std::mt19937_64 random(7);
  for (const double size : {0.05, 0.3, 2.0}) {
    std::uniform_real_distribution<double> at(0, 10), off(-10 * size, 10 * size);
    TriangleMesh mesh;
    for (uint32_t n = 0; n < 200; ++n) {
      const Vertex middle = {at(random), at(random), at(random)};
      for (int corner = 0; corner < 3; ++corner) {
        mesh.vertices.push_back(
            {middle[0] + off(random), middle[1] + off(random), middle[2] + off(random)});
      }
      mesh.triangles.push_back({3 * n, 3 * n + 1, 3 * n + 2});
    }
    uint64_t expected = 0;
    const auto corner = [&](size_t t, size_t n) { return mesh.vertices[3 * t + n % 3]; };
    for (size_t a = 0; a < 200; ++a) {
      for (size_t b = a + 1; b < 200; ++b) {
        bool cross = false;
        for (size_t n = 0; n < 3; ++n) {
          cross = cross ||
                  Meets(corner(a, n), corner(a, n + 1), corner(b, 0), corner(b, 1), corner(b, 2)) ||
                  Meets(corner(b, n), corner(b, n + 1), corner(a, 0), corner(a, 1), corner(a, 2));
        }
        expected += cross ? 1 : 0;
      }
    }
    EXPECT_EQ(CrossingsOf(mesh), expected) << size;
    EXPECT_GT(expected, 0u) << size;
  }
}

// The numbers are those of CGAL's self_intersections() without pairs that only overlap in a plane
// or touch, of which the scorpion has 12.
TEST(Crossings, OfMeshesOfOthersAreThoseThatCgalFinds) {
  BCCSKEL_SKIP_WITHOUT_TEST_DATA();
  const auto crossings = [](const std::string& name) {
    return CrossingsOf(*ReadMeshFile(testing::TestData("mesh/" + name)));
  };
  EXPECT_EQ(crossings("horse.ply"), 4u);
  EXPECT_EQ(crossings("scorpion.ply"), 3u);
  EXPECT_EQ(crossings("elephant.off"), 0u);
  EXPECT_EQ(crossings("gmsh_t13.stl"), 0u);
}

TEST(Crossings, AreNotCountedOnceTheJobIsStopped) {
  std::stop_source source;
  source.request_stop();
  exec::Context context;
  context.stop = source.get_token();
  EXPECT_EQ(CountCrossings(PrepareSurface(Sphere({0, 0, 0}, 1)), context).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel
