#include "core/import/voxelize/crossings.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <stop_token>
#include <string>
#include <utility>
#include <vector>

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

// The walls of a prism over a bow tie cross where edges meet edges, which pierces no interior.
TEST(Crossings, OfEdgesWithEdgesCount) {
  TriangleMesh mesh;
  for (const double z : {0, 1}) {
    mesh.vertices.insert(mesh.vertices.end(), {{0, 0, z}, {1, 1, z}, {1, 0, z}, {0, 1, z}});
  }
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {4, 6, 5}, {4, 7, 6}};
  for (uint32_t n = 0; n < 4; ++n) {
    const uint32_t next = (n + 1) % 4;
    mesh.triangles.push_back({n, next, next + 4});
    mesh.triangles.push_back({n, next + 4, n + 4});
  }
  EXPECT_GE(CountIn(mesh).within_parts, 2u);
}

TEST(Crossings, AreNoneWhereBoxesTouchAnywhere) {
  for (const double off : {0.0, 0.25, 0.5, 1.0}) {
    EXPECT_EQ(CrossingsOf(Merged(Box({0, 0, 0}, {1, 1, 1}), Box({1, off, off / 2}, {2, 2, 2}))), 0u)
        << off;
  }
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

// Triangles with corners on a small grid meet in every degenerate way; integers are exact.
using Whole = std::array<int64_t, 3>;
Whole Between(const Whole& a, const Whole& b) { return Minus(b, a); }
using Corners = std::array<Whole, 3>;

struct Fraction {
  int64_t over, under;  // positive
  bool operator<(const Fraction& other) const { return over * other.under < other.over * under; }
};

// Where the triangle meets a plane that it crosses, along the direction.
std::optional<std::pair<Fraction, Fraction>> Segment(const Corners& t, const Corners& plane,
                                                     const Whole& along) {
  const Whole normal = Cross(Between(plane[0], plane[1]), Between(plane[0], plane[2]));
  std::array<int64_t, 3> height;
  for (size_t n = 0; n < 3; ++n) height[n] = Dot(normal, Between(plane[0], t[n]));
  if (std::ranges::max(height) <= 0 || std::ranges::min(height) >= 0) return std::nullopt;
  std::vector<Fraction> places;
  for (size_t n = 0; n < 3; ++n) {
    const size_t m = (n + 1) % 3;
    const int64_t at = Dot(along, t[n]), to = Dot(along, t[m]);
    if (height[n] == 0) places.push_back({at, 1});
    if (std::min(height[n], height[m]) < 0 && std::max(height[n], height[m]) > 0) {
      const int64_t sign = height[n] > height[m] ? 1 : -1;
      places.push_back({sign * (to * height[n] - at * height[m]), sign * (height[n] - height[m])});
    }
  }
  const auto [low, high] = std::minmax_element(places.begin(), places.end());
  return std::pair(*low, *high);
}

bool ShareASegment(const Corners& s, const Corners& t) {
  const auto normal = [](const Corners& c) {
    return Cross(Between(c[0], c[1]), Between(c[0], c[2]));
  };
  const Whole along = Cross(normal(s), normal(t));
  const auto one = Segment(s, t, along), other = Segment(t, s, along);
  return one && other && std::max(one->first, other->first) < std::min(one->second, other->second);
}

TEST(CrossingsLaw, OfDegeneratePairsAreThoseThatShareASegment) {
  std::mt19937_64 random(11);
  std::uniform_int_distribution<int> at(0, 4);  // the mesh fills a cube of 4: scaling is exact
  int expected = 0;
  for (int n = 0; n < 20000; ++n) {
    std::array<Corners, 2> pair;
    for (Corners& t : pair) {
      for (Whole& corner : t) corner = {at(random), at(random), at(random)};
    }
    TriangleMesh mesh;
    mesh.vertices = {{0, 0, 0}, {4, 4, 4}, {4, 4, 0}};
    mesh.triangles = {{0, 1, 2}};
    std::array<TriangleMesh, 2> alone = {mesh, mesh};
    for (size_t k = 0; k < 2; ++k) {
      const auto first = static_cast<uint32_t>(mesh.vertices.size());
      for (const Whole& c : pair[k]) {
        const Vertex v = {static_cast<double>(c[0]), static_cast<double>(c[1]),
                          static_cast<double>(c[2])};
        mesh.vertices.push_back(v);
        alone[k].vertices.push_back(v);
      }
      mesh.triangles.push_back({first, first + 1, first + 2});
      alone[k].triangles.push_back({3, 4, 5});
    }
    const bool crosses = ShareASegment(pair[0], pair[1]);
    ASSERT_EQ(CrossingsOf(mesh) - CrossingsOf(alone[0]) - CrossingsOf(alone[1]), crosses) << n;
    expected += crosses;
  }
  EXPECT_GT(expected, 1000);
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
