#include <gtest/gtest.h>

#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "core/export/surface/surface_mesh.h"
#include "tests/support/contexts.h"
#include "tests/support/enclosed_volume.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"

namespace bccskel {
namespace {

SurfaceMesh SurfaceOf(std::span<const LatticePoint> points) {
  return *ExtractSurface(VolumeOfPoints(points), {});
}

using Edge = std::pair<uint32_t, uint32_t>;

std::map<Edge, int> DirectedEdgesOf(const SurfaceMesh& mesh) {
  std::map<Edge, int> edges;
  for (const auto& [a, b, c] : mesh.triangles) {
    ++edges[{a, b}];
    ++edges[{b, c}];
    ++edges[{c, a}];
  }
  return edges;
}

// The triangles around a vertex form one ring: from each of them one comes to all others.
bool IsOneRing(const std::map<uint32_t, uint32_t>& next) {
  uint32_t at = next.begin()->first;
  for (size_t step = 1; step < next.size(); ++step) {
    at = next.at(at);
    if (at == next.begin()->first) return false;
  }
  return next.at(at) == next.begin()->first;
}

void ExpectClosedManifold(const SurfaceMesh& mesh) {
  const std::map<Edge, int> edges = DirectedEdgesOf(mesh);
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_TRUE(edges.contains({edge.second, edge.first}));
  }
  std::vector<std::map<uint32_t, uint32_t>> rings(mesh.vertices.size());
  for (const auto& [a, b, c] : mesh.triangles) {
    rings[a][b] = c;
    rings[b][c] = a;
    rings[c][a] = b;
  }
  for (const auto& ring : rings) EXPECT_TRUE(!ring.empty() && IsOneRing(ring));
}

int64_t EulerCharacteristicOf(const SurfaceMesh& mesh) {
  return std::ssize(mesh.vertices) - std::ssize(DirectedEdgesOf(mesh)) / 2 +
         std::ssize(mesh.triangles);
}

int64_t ComponentsOf(const SurfaceMesh& mesh) {
  std::vector<uint32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const auto& [a, b, c] : mesh.triangles) {
    parent[root(a)] = root(b);
    parent[root(b)] = root(c);
  }
  std::set<uint32_t> roots;
  for (uint32_t v = 0; v < parent.size(); ++v) roots.insert(root(v));
  return std::ssize(roots);
}

TEST(ExtractSurfaceTest, AnEmptyObjectHasNone) {
  const SurfaceMesh mesh = SurfaceOf({});
  EXPECT_TRUE(mesh.vertices.empty());
  EXPECT_TRUE(mesh.triangles.empty());
}

TEST(ExtractSurfaceTest, APointIsCoveredByItsTwentyFourTetrahedra) {
  const SurfaceMesh mesh = SurfaceOf({{{4, 4, 4}}});
  EXPECT_EQ(mesh.vertices.size(), 14u);
  EXPECT_EQ(mesh.triangles.size(), 24u);
  EXPECT_GT(test::EnclosedBy(mesh), 0);
}

TEST(ExtractSurfaceTest, PointsAtTheEndsOfTheExtentAreCoveredToo) {
  const LatticePoint all[] = {{0, 0, 0}, {1, 1, 1}};
  const SurfaceMesh mesh = SurfaceOf(all);
  ExpectClosedManifold(mesh);
  EXPECT_EQ(EulerCharacteristicOf(mesh), 2);
}

TEST(ExtractSurfaceTest, NoiseHasAClosedManifoldWithTwiceItsEulerCharacteristic) {
  for (uint64_t seed = 0; seed < 12; ++seed) {
    const double density = 0.05 + 0.08 * static_cast<double>(seed);
    const auto points = test::RandomCloud(seed, {20, 9, 10}, density);
    const SurfaceMesh mesh = SurfaceOf(points);
    ExpectClosedManifold(mesh);
    const BettiNumbers betti = test::ReferenceBetti(test::ReferencePointSet(points));
    EXPECT_EQ(EulerCharacteristicOf(mesh), 2 * betti.EulerCharacteristic()) << "seed " << seed;
    EXPECT_EQ(ComponentsOf(mesh), betti.components + betti.cavities) << "seed " << seed;
  }
}

TEST(ExtractSurfaceTest, BlobsAreEnclosedByAboutTheirVolume) {
  for (uint64_t seed = 0; seed < 4; ++seed) {
    const auto points = test::RandomBlob(seed, {24, 24, 24}, 5, 12);
    const SurfaceMesh mesh = SurfaceOf(points);
    ExpectClosedManifold(mesh);
    // A lattice point stands for four cubic lattice units.
    const double enclosed = test::EnclosedBy(mesh) / 4;
    EXPECT_NEAR(enclosed / static_cast<double>(points.size()), 1, 0.03) << "seed " << seed;
  }
}

TEST(ExtractSurfaceTest, StopsWhenItIsToldTo) {
  const exec::Context context = test::Stopped();
  const auto points = test::RandomCloud(1, {8, 8, 8}, 0.5);
  EXPECT_EQ(ExtractSurface(VolumeOfPoints(points), context).status().code(),
            absl::StatusCode::kCancelled);
}

}  // namespace
}  // namespace bccskel
