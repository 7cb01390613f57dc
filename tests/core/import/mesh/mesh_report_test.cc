#include "core/import/mesh/mesh_report.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/import/mesh/weld.h"
#include "tests/core/import/mesh/mesh_shapes.h"

namespace bccskel {
namespace {

using testing::Box;
using testing::Flipped;
using testing::Merged;
using testing::Sphere;

TEST(MeshReport, DescribesABox) {
  const MeshReport report = AnalyzeMesh(Box({1, 2, 3}, {2, 4, 6}));
  EXPECT_EQ(report.vertices, 8u);
  EXPECT_EQ(report.edges, 18u);
  EXPECT_EQ(report.triangles, 12u);
  EXPECT_TRUE(report.watertight());
  EXPECT_TRUE(report.consistently_oriented());
  EXPECT_EQ(report.closure, SurfaceClosure::kOriented);
  EXPECT_DOUBLE_EQ(report.volume, 6);
  EXPECT_EQ(report.genus, 0);
  EXPECT_EQ(report.lower, (std::array<double, 3>{1, 2, 3}));
  EXPECT_EQ(report.upper, (std::array<double, 3>{2, 4, 6}));
  EXPECT_EQ(report.SolidByWinding(), (SolidTopology{1, 0, 0}));
}

TEST(MeshReport, FindsTheGenusOfTorusAndKnotAndTheSignOfTheirVolume) {
  const MeshReport torus = AnalyzeMesh(testing::Torus(3, 1, 200, 100));
  EXPECT_EQ(torus.genus, 1);
  EXPECT_NEAR(torus.volume, 2 * std::numbers::pi * std::numbers::pi * 3, 0.1);
  EXPECT_EQ(torus.SolidByParity(), (SolidTopology{1, 1, 0}));
  const MeshReport knot = AnalyzeMesh(Flipped(testing::TrefoilTube(0.3)));
  EXPECT_EQ(knot.genus, 1);
  EXPECT_EQ(std::signbit(knot.volume),
            !std::signbit(AnalyzeMesh(testing::TrefoilTube(0.3)).volume));
  EXPECT_EQ(knot.SolidByWinding(), (SolidTopology{1, 1, 0}));
}

TEST(WeldVertices, NumbersJoinedVerticesByFirstAppearance) {
  const TriangleMesh mesh = {{{1, 0, 0}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-0.0, 0, 0}},
                             {{0, 1, 3}, {2, 4, 3}}};
  const TriangleMesh welded = {{{1, 0, 0}, {0, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 1, 2}}};
  EXPECT_EQ(WeldVertices(mesh), welded);
}

TEST(MeshReport, JoinsEqualCornersWhereThatClosesTheSurface) {
  const MeshReport report = AnalyzeMesh(testing::Unshared(testing::Torus(3, 1)));
  EXPECT_TRUE(report.watertight());
  EXPECT_EQ(report.vertices, 48u * 24u);
  EXPECT_EQ(report.genus, 1);
}

TEST(MeshReport, KeepsClosedPartsThatTouchApart) {
  const MeshReport edge = AnalyzeMesh(Merged(Box({0, 0, 0}, {1, 1, 1}), Box({1, 1, 0}, {2, 2, 1})));
  EXPECT_TRUE(edge.watertight());
  EXPECT_EQ(edge.components.size(), 2u);
  // Without shared corners nothing tells the parts apart: four triangles meet in an edge.
  const MeshReport soup =
      AnalyzeMesh(testing::Unshared(Merged(Box({0, 0, 0}, {1, 1, 1}), Box({1, 1, 0}, {2, 2, 1}))));
  EXPECT_EQ(soup.non_manifold_edges, 1u);
  EXPECT_EQ(soup.closure, SurfaceClosure::kOriented);
  EXPECT_FALSE(soup.watertight());
}

TEST(MeshReport, TakesAPinchedVertexApart) {
  TriangleMesh mesh = Merged(Box({0, 0, 0}, {1, 1, 1}), Box({1, 1, 1}, {2, 2, 2}));
  for (auto& t : mesh.triangles) {
    for (uint32_t& v : t) v = v == 8 ? 7 : v;  // the corner they share
  }
  const MeshReport report = AnalyzeMesh(mesh);
  EXPECT_EQ(report.components.size(), 2u);
  EXPECT_EQ(report.vertices, 15u);
  EXPECT_EQ(report.genus, 0);
}

TEST(MeshReport, CountsTheBoundaryOfAnOpenMesh) {
  TriangleMesh mesh = Box({0, 0, 0}, {1, 1, 1});
  mesh.triangles.pop_back();
  const MeshReport report = AnalyzeMesh(mesh);
  EXPECT_EQ(report.boundary_edges, 3u);
  EXPECT_EQ(report.misoriented_edges, 0u);
  EXPECT_EQ(report.closure, SurfaceClosure::kOpen);
  EXPECT_EQ(report.genus, std::nullopt);
  EXPECT_EQ(report.SolidByParity(), std::nullopt);
}

TEST(MeshReport, CountsEdgesThatTwoTrianglesPassAlike) {
  TriangleMesh mesh = Box({0, 0, 0}, {1, 1, 1});
  std::swap(mesh.triangles[0][0], mesh.triangles[0][1]);
  const MeshReport report = AnalyzeMesh(mesh);
  EXPECT_TRUE(report.watertight());
  EXPECT_EQ(report.misoriented_edges, 3u);
  EXPECT_EQ(report.closure, SurfaceClosure::kClosed);
  EXPECT_EQ(report.SolidByParity(), (SolidTopology{1, 0, 0}));
  EXPECT_EQ(report.SolidByWinding(), std::nullopt);
}

TEST(MeshReport, DropsDegenerateTrianglesOnlyWhereTheyOpenTheSurface) {
  TriangleMesh mesh = Box({0, 0, 0}, {1, 1, 1});
  mesh.vertices.push_back({0.5, 0, 0});
  mesh.triangles.push_back({0, 0, 1});
  mesh.triangles.push_back({0, 1, 8});  // flat, with two open edges
  EXPECT_EQ(AnalyzeMesh(mesh).dropped_triangles, 2u);
  EXPECT_TRUE(AnalyzeMesh(mesh).watertight());
  // A flat triangle that fills a T-junction stays: 0-1 is cut at 8 on one side only.
  TriangleMesh split = Box({0, 0, 0}, {1, 1, 1});
  split.vertices.push_back({0.5, 0, 0});
  split.triangles[4] = {0, 8, 5};
  split.triangles.push_back({8, 1, 5});
  split.triangles.push_back({0, 1, 8});
  EXPECT_EQ(AnalyzeMesh(split).dropped_triangles, 0u);
  EXPECT_TRUE(AnalyzeMesh(split).watertight());
}

TEST(MeshReport, FindsCavitiesAndWhatFloatsInThem) {
  const TriangleMesh hollow = Merged(Sphere({0, 0, 0}, 3), Flipped(Sphere({0, 0, 0}, 2)));
  EXPECT_EQ(AnalyzeMesh(hollow).SolidByWinding(), (SolidTopology{1, 0, 1}));
  EXPECT_EQ(AnalyzeMesh(Flipped(hollow)).SolidByWinding(), (SolidTopology{1, 0, 1}));
  const MeshReport nested = AnalyzeMesh(Merged(Sphere({0, 0, 0}, 1), hollow));
  EXPECT_EQ(nested.components[0].depth, 2);
  EXPECT_EQ(nested.components[1].depth, 0);
  EXPECT_EQ(nested.components[2].depth, 1);
  EXPECT_EQ(nested.components[0].root, 1u);
  EXPECT_EQ(nested.SolidByWinding(), (SolidTopology{2, 0, 1}));
  EXPECT_EQ(nested.SolidByParity(), (SolidTopology{2, 0, 1}));
}

// All corners of the rung lie in one post or the other, and the box around a slanting post is wide.
TEST(MeshReport, FindsNoShellInsideAnotherWhereTheyOnlyOverlap) {
  TriangleMesh posts =
      Merged(Box({-2.4, -0.4, -9}, {-1.6, 0.4, 9}), Box({1.6, -0.4, -9}, {2.4, 0.4, 9}));
  TriangleMesh ladder = Merged(Box({-2, -0.2, -0.2}, {2, 0.2, 0.2}), posts);
  for (TriangleMesh::Vertex& v : ladder.vertices) {
    const double x = v[0] / std::sqrt(2.0), y = v[1] / std::sqrt(6.0), z = v[2] / std::sqrt(3.0);
    v = {x + y + z, -x + y + z, z - 2 * y};
  }
  for (const SurfaceComponent& component : AnalyzeMesh(ladder).components) {
    EXPECT_EQ(component.depth, 0);
  }
}

TEST(MeshReport, TellsTheTwoRulesApartForShellsOfOneOrientation) {
  const MeshReport report = AnalyzeMesh(Merged(Sphere({0, 0, 0}, 3), Sphere({0, 0, 0}, 2)));
  EXPECT_EQ(report.SolidByWinding(), (SolidTopology{1, 0, 0}));
  EXPECT_EQ(report.SolidByParity(), (SolidTopology{1, 0, 1}));
}

TEST(MeshReport, NeitherOverflowsNorUnderflows) {
  for (double scale : {1e-160, 1e-30, 1e30, 1e307}) {
    const MeshReport report = AnalyzeMesh(testing::Moved(Sphere({0, 0, 0}, 1), scale, {0, 0, 0}));
    EXPECT_TRUE(report.watertight()) << scale;
    EXPECT_EQ(report.dropped_triangles, 0u) << scale;
    EXPECT_FALSE(std::isnan(report.volume)) << scale;
  }
}

TEST(MeshReport, KeepsTheVolumeOfASmallPartFarFromALargeOne) {
  const MeshReport report =
      AnalyzeMesh(Merged(Sphere({0, 0, 0}, 1), Box({1e6, 0, 0}, {1e6 + 0.5, 0.5, 0.5})));
  EXPECT_NEAR(report.components[1].volume, 0.125, 1e-6);
}

TEST(MeshReport, ManagesThousandsOfNestedParts) {
  TriangleMesh mesh = Box({-1, -1, -1}, {200, 200, 200});
  for (int n = 0; n < 3000; ++n) {
    const double x = n % 15, y = n / 15 % 15, z = n / 225;
    mesh = Merged(mesh, Flipped(Box({9 * x, 9 * y, 9 * z}, {9 * x + 8, 9 * y + 8, 9 * z + 8})));
  }
  EXPECT_EQ(AnalyzeMesh(mesh).SolidByWinding(), (SolidTopology{1, 0, 3000}));
}

}  // namespace
}  // namespace bccskel
