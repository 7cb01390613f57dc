#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>
#include <set>

#include "core/certificate/certificate.h"
#include "core/lattice/directions.h"
#include "core/skeleton/junction_merger.h"
#include "core/topology/neighborhood.h"
#include "tests/core/skeleton/traced.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_point_set.h"

namespace bccskel {
namespace {

using test::RandomBlob;
using test::RandomCloud;
using test::ReferencePointSet;

int64_t CountComponents(const SkeletonGraph& graph) {
  std::vector<size_t> root(graph.nodes.size());
  std::iota(root.begin(), root.end(), size_t{0});
  auto components = static_cast<int64_t>(root.size());
  for (const SkeletonEdge& edge : graph.edges) {
    const size_t from = root[edge.source], to = root[edge.target];
    if (from == to) continue;
    std::ranges::replace(root, from, to);
    --components;
  }
  return components;
}

BettiNumbers BettiOf(const SkeletonGraph& graph) {
  BettiNumbers betti;
  betti.components = CountComponents(graph);
  betti.loops = static_cast<int64_t>(graph.edges.size()) -
                static_cast<int64_t>(graph.nodes.size()) + betti.components;
  for (const SkeletonNode& node : graph.nodes) {
    betti.loops += node.loops;
    betti.cavities += node.cavities;
  }
  return betti;
}

void ExpectNodesToBeOfTheirKind(const SkeletonGraph& graph) {
  std::vector<int> degree(graph.nodes.size()), self(graph.nodes.size());
  for (const SkeletonEdge& edge : graph.edges) {
    ++degree[edge.source];
    ++degree[edge.target];
    self[edge.source] += edge.source == edge.target ? 1 : 0;
  }
  for (size_t n = 0; n < graph.nodes.size(); ++n) {
    const SkeletonNode& node = graph.nodes[n];
    switch (node.kind) {
      case NodeKind::kEnd:
        EXPECT_EQ(degree[n], 1);
        break;
      case NodeKind::kIsolated:
        EXPECT_EQ(degree[n], 0);
        break;
      case NodeKind::kLoop:
        EXPECT_EQ(degree[n], 2);
        EXPECT_EQ(self[n], 1);
        break;
      case NodeKind::kJunction:
        EXPECT_GE(degree[n], 3);
        break;
      case NodeKind::kClosedSurface:
        EXPECT_GE(node.cavities, 1u);
        break;
    }
    if (node.kind != NodeKind::kClosedSurface) {
      EXPECT_EQ(node.loops + node.cavities, 0u);
    }
  }
}

void ExpectEdgesToRunFromSourceToTarget(const SkeletonGraph& graph, const Volume& thin) {
  uint64_t first = 0;
  for (const SkeletonEdge& edge : graph.edges) {
    const auto path = graph.PointsOf(edge);
    ASSERT_EQ(edge.first_point, first);
    first += edge.point_count;
    ASSERT_GE(path.size(), 2u);
    EXPECT_EQ(path.front(), graph.nodes[edge.source].at);
    EXPECT_EQ(path.back(), graph.nodes[edge.target].at);
    for (size_t n = 0; n < path.size(); ++n) {
      EXPECT_TRUE(thin.Contains(path[n].point));
      if (n > 0) {
        EXPECT_TRUE(FindDirection(path[n].point - path[n - 1].point));
      }
    }
  }
  EXPECT_EQ(first, graph.points.size());
}

void ExpectCanonicalOrder(const SkeletonGraph& graph) {
  for (size_t n = 1; n < graph.nodes.size(); ++n) {
    EXPECT_LT(graph.nodes[n - 1].at.point, graph.nodes[n].at.point);
  }
  using Key = std::tuple<uint32_t, uint32_t, std::vector<SkeletonPoint>>;
  std::vector<Key> keys;
  for (const SkeletonEdge& edge : graph.edges) {
    const auto path = graph.PointsOf(edge);
    keys.emplace_back(edge.source, edge.target, std::vector(path.begin(), path.end()));
    const Key back(edge.target, edge.source, std::vector(path.rbegin(), path.rend()));
    EXPECT_LE(keys.back(), back);
  }
  EXPECT_TRUE(std::ranges::is_sorted(keys));
}

// Points with two neighbors that are not adjacent lie inside exactly one edge, once.
void ExpectPlainCurvePointsOnce(const SkeletonGraph& graph, const Volume& thin) {
  std::map<LatticePoint, int> uses;
  for (const SkeletonEdge& edge : graph.edges) {
    const auto path = graph.PointsOf(edge);
    for (const SkeletonPoint& p : path.first(path.size() - 1)) ++uses[p.point];
  }
  const ReferencePointSet set(thin);
  thin.ForEachPoint([&](LatticePoint p) {
    const NeighborMask mask = set.NeighborsOf(p);
    if (IsCurvePoint(mask) && ComponentsIn(mask) == 2) {
      EXPECT_EQ(uses[p], 1);
    }
  });
}

// Every point of the volume is on an edge, a node's or one of a sheet, and none is both.
void ExpectAllPoints(const SkeletonGraph& graph, const Volume& thin, const test::Depth& depth) {
  std::set<LatticePoint> found;
  for (const SkeletonNode& node : graph.nodes) found.insert(node.at.point);
  for (const SkeletonPoint& p : graph.points) found.insert(p.point);
  EXPECT_EQ(found.size() + graph.sheets.size(), thin.PointCount());
  for (const SkeletonPoint& p : graph.sheets) {
    EXPECT_TRUE(found.insert(p.point).second);
    EXPECT_EQ(p.radius, depth(p.point));
  }
  EXPECT_EQ(std::vector(found.begin(), found.end()), thin.SortedPoints());
  EXPECT_TRUE(std::ranges::is_sorted(graph.sheets));
}

void ExpectGraphOf(const Volume& thin, const BettiNumbers& expected, const SkeletonGraph& graph,
                   const test::Depth& depth) {
  const BettiNumbers found = BettiOf(graph);
  EXPECT_EQ(found.components, expected.components);
  EXPECT_EQ(found.loops, expected.loops);
  EXPECT_EQ(found.cavities, expected.cavities);
  ExpectNodesToBeOfTheirKind(graph);
  ExpectEdgesToRunFromSourceToTarget(graph, thin);
  ExpectCanonicalOrder(graph);
  ExpectAllPoints(graph, thin, depth);
}

float ShallowDepth(LatticePoint p) { return (test::RuggedDepth(p) - 177) / 4; }

void ExpectInvariants(const std::vector<LatticePoint>& points) {
  const Volume thin = VolumeOfPoints(points);
  const BettiNumbers expected = CountBettiNumbers(thin, {}).value();
  // All junctions of a component lie in one ball, or some do.
  for (const test::Depth& depth : {test::Depth(test::RuggedDepth), test::Depth(ShallowDepth)}) {
    SkeletonGraph graph = test::Trace(points, depth);
    ExpectGraphOf(thin, expected, graph, depth);
    ExpectPlainCurvePointsOnce(graph, thin);
    const size_t nodes = graph.nodes.size();
    ASSERT_TRUE(MergeJunctions(kDefaultJunctionReach, {}, graph).ok());
    EXPECT_LE(graph.nodes.size(), nodes);
    ExpectGraphOf(thin, expected, graph, depth);
  }
}

// Removes points that are simple and no end points, one after the other.
std::vector<LatticePoint> ThinnedOneByOne(const std::vector<LatticePoint>& points) {
  ReferencePointSet set(points);
  for (bool again = true; again;) {
    again = false;
    for (LatticePoint p : points) {
      if (!set.Contains(p) || !IsSimpleNonEnd(set.NeighborsOf(p))) continue;
      set.Erase(p);
      again = true;
    }
  }
  return set.SortedPoints();
}

TEST(TraceSkeletonLaw, KeepsTheTopologyOfRandomCloudsOfAllDensities) {
  for (uint64_t seed = 0; seed < 3000 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    ExpectInvariants(RandomCloud(seed, {5, 4, 4}, static_cast<double>(seed % 30 + 1) / 30.0));
  }
}

TEST(TraceSkeletonLaw, KeepsTheTopologyOfThinnedRandomClouds) {
  for (uint64_t seed = 0; seed < 600 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    ExpectInvariants(
        ThinnedOneByOne(RandomCloud(seed, {7, 6, 6}, static_cast<double>(seed % 30 + 1) / 30.0)));
  }
}

TEST(TraceSkeletonLaw, KeepsTheTopologyOfSparseNetsOfThickLines) {
  for (uint64_t seed = 0; seed < 300 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const auto thin = ThinnedOneByOne(RandomCloud(seed, {8, 8, 8}, 0.6));
    auto net = test::RandomSubset(seed, RandomCloud(seed + 1, {8, 8, 8}, 1), 0.05);
    net.insert(net.end(), thin.begin(), thin.end());
    ExpectInvariants(net);
  }
}

TEST(TraceSkeletonLaw, KeepsTheTopologyOfThickBlobsAndTheirShells) {
  for (uint64_t seed = 0; seed < 40 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const auto blob = RandomBlob(seed, {14, 14, 14}, 6, 9);
    ExpectInvariants(blob);
    ExpectInvariants(test::WithNoisyBoundary(seed, blob, 0.3));
    const ReferencePointSet solid(blob);
    std::vector<LatticePoint> border;
    for (LatticePoint p : blob) {
      if (solid.NeighborsOf(p) != kAllNeighbors) border.push_back(p);
    }
    ExpectInvariants(border);
    ExpectInvariants(test::RandomSubset(seed, border, 0.9));
    ExpectInvariants(ThinnedOneByOne(border));
  }
}

TEST(TraceSkeletonLaw, MovingTheObjectMovesTheGraph) {
  for (uint64_t seed = 0; seed < 20; ++seed) {
    const auto points = ThinnedOneByOne(RandomCloud(seed, {9, 9, 9}, 0.5));
    const SkeletonGraph graph = test::Trace(points);
    for (int32_t shift : {1, 5, 15, 16, 31}) {
      const LatticePoint by = {shift, shift + 2, shift + 4};
      const SkeletonGraph moved = test::Trace(test::Translated(points, by));
      ASSERT_EQ(moved.edges, graph.edges);
      ASSERT_EQ(moved.nodes.size(), graph.nodes.size());
      for (size_t n = 0; n < graph.nodes.size(); ++n) {
        ASSERT_EQ(moved.nodes[n].at.point, graph.nodes[n].at.point + by);
      }
      for (size_t n = 0; n < graph.points.size(); ++n) {
        ASSERT_EQ(moved.points[n].point, graph.points[n].point + by);
      }
    }
  }
}

// A layer of a plate that is no thicker: a loop for each square, and one hair beside a triangle.
TEST(TraceSkeletonLaw, EdgesOfLayersShareTheirPaths) {
  for (int32_t width : {30, 60, 100}) {
    std::vector<LatticePoint> points;
    for (int32_t y = 10; y <= 50; y += 2) {
      for (int32_t x = 10; x <= 10 + width; x += 2) points.push_back({x, y, 10});
    }
    points.push_back({9, 9, 11});
    for (int32_t n = 1; n < 10; ++n) points.push_back({n, n, n});
    ExpectInvariants(points);
    EXPECT_LT(test::Trace(points).points.size(), 5 * points.size());
  }
}

// A solid plate with hairs at one end and its deepest points at the other, where nothing starts.
TEST(TraceSkeletonLaw, TheDeepestPointOfALargeClusterMayBeNoNode) {
  for (int32_t deepest = 0; deepest < 30; deepest += 2) {
    SCOPED_TRACE(deepest);
    std::vector<LatticePoint> points;
    for (int32_t y = 0; y < 24; y += 2) {
      for (int32_t x = 0; x < 240; x += 2) {
        points.push_back({x, y, 0});
        points.push_back({x + 1, y + 1, 1});
        if (x < 60 || x % 4 != 0 || y % 4 != 0) continue;
        for (int32_t z = 2; z < 8; z += 2) points.push_back({x, y, z});
      }
    }
    const test::Depth depth = [&](LatticePoint p) {
      return static_cast<float>(300 - std::abs(p.x) - std::abs(p.y - deepest));
    };
    const Volume plate = VolumeOfPoints(points);
    const SkeletonGraph graph = test::Trace(points, depth);
    ExpectGraphOf(plate, CountBettiNumbers(plate, {}).value(), graph, depth);
    EXPECT_GT(std::ranges::count(graph.nodes, NodeKind::kJunction, &SkeletonNode::kind), 10);
  }
}

// With one node for each cluster, every edge would have a path of its own to the middle.
TEST(TraceSkeletonLaw, EdgesOfLargeClustersShareTheirPaths) {
  for (uint64_t seed = 0; seed < 12 && !HasFailure(); ++seed) {
    SCOPED_TRACE(seed);
    const double density = 0.35 + 0.05 * static_cast<double>(seed);
    for (const auto& size : {std::array{20, 20, 3}, {60, 40, 1}, {300, 4, 4}}) {
      const auto points = RandomCloud(seed, {size[0], size[1], size[2]}, density);
      ExpectInvariants(points);
      const SkeletonGraph graph = test::Trace(points);
      EXPECT_LT(graph.points.size(), 8 * points.size() + 4096);
    }
  }
}

TEST(TraceSkeletonLaw, PathsOfALongSpongeFollowItsPoints) {
  std::mt19937 random(17);
  std::vector<LatticePoint> points;
  for (int32_t z = 0; z < 3000; ++z) {
    for (int32_t y = z % 2; y < 6; y += 2) {
      for (int32_t x = z % 2; x < 6; x += 2) {
        if (random() % 100 < 60) points.push_back({x, y, z});
      }
    }
  }
  const Volume sponge = VolumeOfPoints(points);
  const SkeletonGraph graph = TraceSkeleton({sponge, test::RadiiOf(sponge)}, {}).value();
  EXPECT_LT(graph.points.size(), 4 * points.size());
  EXPECT_EQ(BettiOf(graph), CountBettiNumbers(sponge, {}).value());
}

}  // namespace
}  // namespace bccskel
