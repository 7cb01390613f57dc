#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/certificate/certificate.h"
#include "core/lattice/directions.h"
#include "tests/core/skeleton/traced.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {

void PrintTo(const SkeletonNode& node, std::ostream* out) {
  *out << "{kind " << static_cast<int>(node.kind) << " at " << node.at.point.x << ","
       << node.at.point.y << "," << node.at.point.z << " loops " << node.loops << " cavities "
       << node.cavities << "}";
}

namespace {

using test::Trace;
using Points = std::vector<LatticePoint>;

// Even points in D6 steps along the given corners. Even points alone are never mutually adjacent in
// threes, so such lines are thin.
Points Polyline(const Points& corners) {
  Points points = {corners.front()};
  const auto toward = [](int32_t from, int32_t to) { return from < to ? 2 : from > to ? -2 : 0; };
  for (const LatticePoint& corner : corners) {
    while (points.back() != corner) {
      const LatticePoint p = points.back();
      points.push_back(
          p + LatticePoint{toward(p.x, corner.x), toward(p.y, corner.y), toward(p.z, corner.z)});
    }
  }
  return points;
}

Points Union(const std::vector<Points>& parts) {
  Points all;
  for (const Points& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

Points ShellAround(LatticePoint center) {
  Points shell;
  for (LatticePoint offset : kDirections14) shell.push_back(center + offset);
  return shell;
}

std::vector<NodeKind> KindsOf(const SkeletonGraph& graph) {
  std::vector<NodeKind> kinds;
  for (const SkeletonNode& node : graph.nodes) kinds.push_back(node.kind);
  std::ranges::sort(kinds);
  return kinds;
}

Points PathOf(const SkeletonGraph& graph, size_t edge) {
  Points path;
  for (const SkeletonPoint& p : graph.PointsOf(graph.edges[edge])) path.push_back(p.point);
  return path;
}

// A hexagon around (8, 8, 8).
const Points kHexagon = {{6, 8, 8}, {7, 7, 9}, {8, 6, 8}, {9, 7, 7}, {8, 8, 6}, {7, 9, 7}};

constexpr NodeKind kEnd = NodeKind::kEnd, kJunction = NodeKind::kJunction, kLoop = NodeKind::kLoop,
                   kIsolated = NodeKind::kIsolated, kClosedSurface = NodeKind::kClosedSurface;
using Kinds = std::vector<NodeKind>;

TEST(TraceSkeleton, OfNothingIsTheEmptyGraph) {
  const SkeletonGraph graph = TraceSkeleton({}, {}).value();
  EXPECT_TRUE(graph.nodes.empty() && graph.edges.empty() && graph.points.empty());
}

TEST(TraceSkeleton, OfOnePointIsAnIsolatedNode) {
  const SkeletonGraph graph = Trace({{5, 7, 9}});
  EXPECT_EQ(graph.nodes, (std::vector<SkeletonNode>{{kIsolated, {{5, 7, 9}, 1}, 0, 0}}));
  EXPECT_TRUE(graph.edges.empty());
}

TEST(TraceSkeleton, OfTwoNeighborsIsTwoEndsAndAnEdgeOfTwoPoints) {
  const SkeletonGraph graph = Trace({{4, 4, 4}, {5, 5, 5}});
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kEnd}));
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(PathOf(graph, 0), (Points{{4, 4, 4}, {5, 5, 5}}));
}

TEST(TraceSkeleton, OfThreeMutuallyAdjacentPointsIsIsolatedNotALoop) {
  const SkeletonGraph graph = Trace({{4, 4, 4}, {5, 5, 5}, {6, 4, 4}});
  EXPECT_EQ(KindsOf(graph), (Kinds{kIsolated}));
  EXPECT_TRUE(graph.edges.empty());
}

TEST(TraceSkeleton, OfALineRunsFromTheSmallerEndToTheLargerOne) {
  const SkeletonGraph graph = Trace(Polyline({{8, 4, 4}, {0, 4, 4}, {0, 0, 4}}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kEnd}));
  EXPECT_EQ(graph.nodes[0].at.point, (LatticePoint{0, 0, 4}));
  EXPECT_EQ(PathOf(graph, 0), Polyline({{0, 0, 4}, {0, 4, 4}, {8, 4, 4}}));
}

TEST(TraceSkeleton, OfAStarIsAJunctionWithFourEnds) {
  const SkeletonGraph graph = Trace({{8, 8, 8}, {9, 9, 9}, {7, 7, 9}, {9, 7, 7}, {7, 9, 7}});
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kEnd, kEnd, kEnd, kJunction}));
  EXPECT_EQ(graph.edges.size(), 4u);
}

TEST(TraceSkeleton, OfAClosedCurveIsALoopAtItsDeepestPoint) {
  const SkeletonGraph graph =
      Trace(kHexagon, [](LatticePoint p) -> uint16_t { return p.x >= 8 ? 300 : 200; });
  EXPECT_EQ(graph.nodes, (std::vector<SkeletonNode>{{kLoop, {{8, 8, 6}, 300}, 0, 0}}));
  EXPECT_EQ(PathOf(graph, 0),
            (Points{{8, 8, 6}, {9, 7, 7}, {8, 6, 8}, {7, 7, 9}, {6, 8, 8}, {7, 9, 7}, {8, 8, 6}}));
}

TEST(TraceSkeleton, OfAHexagonWithSixArmsKeepsTheLoopOfItsCluster) {
  Points points = kHexagon;
  for (LatticePoint p : kHexagon) {
    points.push_back(p + (p - LatticePoint{8, 8, 8}));
  }
  const SkeletonGraph graph = Trace(points);
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kEnd, kEnd, kEnd, kEnd, kEnd, kJunction}));
  EXPECT_EQ(graph.edges.size(), 7u);
  const auto self = std::ranges::find_if(
      graph.edges, [](const SkeletonEdge& edge) { return edge.source == edge.target; });
  ASSERT_NE(self, graph.edges.end());
  EXPECT_EQ(self->point_count, 7u);
}

TEST(TraceSkeleton, OfAThetaIsTwoJunctionsAndThreeEdges) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{0, 0, 0}, {12, 0, 0}, {12, 8, 0}, {0, 8, 0}, {0, 0, 0}}),
                   Polyline({{0, 4, 0}, {12, 4, 0}})}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kJunction, kJunction}));
  ASSERT_EQ(graph.edges.size(), 3u);
  for (const SkeletonEdge& edge : graph.edges) {
    EXPECT_EQ(edge.source, 0u);
    EXPECT_EQ(edge.target, 1u);
  }
}

TEST(TraceSkeleton, OfAFigureEightIsAJunctionWithTwoEdgesToItself) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{8, 8, 0}, {0, 8, 0}, {0, 0, 0}, {8, 0, 0}, {8, 8, 0}}),
                   Polyline({{8, 8, 0}, {16, 8, 0}, {16, 16, 0}, {8, 16, 0}, {8, 8, 0}})}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kJunction}));
  EXPECT_EQ(graph.nodes[0].at.point, (LatticePoint{8, 8, 0}));
  ASSERT_EQ(graph.edges.size(), 2u);
  EXPECT_EQ(graph.edges[0].point_count, 17u);
}

TEST(TraceSkeleton, OfAWheelHasALoopForEachPairOfSpokes) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{0, 0, 4}, {16, 0, 4}, {16, 16, 4}, {0, 16, 4}, {0, 0, 4}}),
                   Polyline({{0, 8, 4}, {16, 8, 4}}), Polyline({{8, 0, 4}, {8, 16, 4}})}));
  EXPECT_EQ(KindsOf(graph), Kinds(5, kJunction));
  EXPECT_EQ(graph.edges.size(), 8u);
}

TEST(TraceSkeleton, OfLinkedRingsIsTwoLoops) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{0, 0, 8}, {16, 0, 8}, {16, 16, 8}, {0, 16, 8}, {0, 0, 8}}),
                   Polyline({{8, 8, 0}, {8, 24, 0}, {8, 24, 16}, {8, 8, 16}, {8, 8, 0}})}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kLoop, kLoop}));
  EXPECT_EQ(graph.edges.size(), 2u);
}

TEST(TraceSkeleton, OfARingWithATailIsAJunctionThatAnEdgeLeadsBackTo) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {0, 8, 0}, {0, 0, 0}}),
                   Polyline({{8, 4, 0}, {16, 4, 0}})}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kJunction}));
  EXPECT_EQ(graph.edges.size(), 2u);
}

// (3, 3, 1) and its two neighbors are a triangle.
TEST(TraceSkeleton, GoesThroughAThickSpotOfOneBranch) {
  const SkeletonGraph graph =
      Trace({{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}, {3, 3, 1}});
  EXPECT_EQ(KindsOf(graph), (Kinds{kEnd, kEnd}));
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(PathOf(graph, 0),
            (Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2}, {3, 3, 3}, {4, 4, 4}, {5, 5, 5}}));
}

TEST(TraceSkeleton, OfAClosedCurveWithAThickSpotIsALoop) {
  const SkeletonGraph graph = Trace(Union({kHexagon, {{5, 7, 9}}}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kLoop}));
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.edges[0].point_count, 7u);
}

TEST(TraceSkeleton, OfAClosedCurveWithTwoThickSpotsIsALoop) {
  const SkeletonGraph graph =
      Trace(Union({Polyline({{4, 4, 4}, {20, 4, 4}, {20, 20, 4}, {4, 20, 4}, {4, 4, 4}}),
                   {{9, 3, 3}, {13, 21, 5}}}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kLoop}));
  ASSERT_EQ(graph.edges.size(), 1u);
  EXPECT_EQ(graph.edges[0].point_count, 33u);
}

TEST(TraceSkeleton, OfALineWithAThickTipEndsAtTheTipsDeepestPoint) {
  const auto depth = [](LatticePoint p) -> uint16_t {
    return p == LatticePoint{1, 1, -1 + 4} ? 9 : 5;
  };
  const SkeletonGraph graph = Trace({{0, 0, 4}, {1, 1, 5}, {1, 1, 3}, {2, 2, 6}, {3, 3, 7}}, depth);
  EXPECT_EQ(graph.nodes, (std::vector<SkeletonNode>{{kEnd, {{1, 1, 3}, 9}, 0, 0},
                                                    {kEnd, {{3, 3, 7}, 5}, 0, 0}}));
  EXPECT_EQ(PathOf(graph, 0), (Points{{1, 1, 3}, {1, 1, 5}, {2, 2, 6}, {3, 3, 7}}));
}

TEST(TraceSkeleton, OfTheShellOfAPointIsAClosedSurface) {
  const SkeletonGraph graph = Trace(ShellAround({8, 8, 8}));
  EXPECT_EQ(graph.nodes, (std::vector<SkeletonNode>{{kClosedSurface, {{8, 8, 6}, 1}, 0, 1}}));
  EXPECT_TRUE(graph.edges.empty());
}

TEST(TraceSkeleton, OfAClosedSurfaceWithAHandleIsANodeWithAnEdgeToItself) {
  const SkeletonGraph graph =
      Trace(Union({ShellAround({8, 8, 8}),
                   Polyline({{10, 8, 8}, {16, 8, 8}, {16, 8, 20}, {8, 8, 20}, {8, 8, 10}})}));
  EXPECT_EQ(KindsOf(graph), (Kinds{kClosedSurface}));
  EXPECT_EQ(graph.nodes[0].cavities, 1u);
  EXPECT_EQ(graph.nodes[0].loops, 0u);
  EXPECT_EQ(graph.edges.size(), 1u);
}

TEST(TraceSkeleton, OfAHollowTorusIsAClosedSurfaceWithTwoLoops) {
  Points shell;
  for (LatticePoint p : test::RandomCloud(0, {24, 24, 10}, 1)) {
    const double r = std::hypot(std::hypot(p.x - 24, p.y - 24) - 14, p.z - 10);
    if (r <= 9 && r > 5) shell.push_back(p);
  }
  const SkeletonGraph graph = Trace(shell);
  EXPECT_EQ(KindsOf(graph), (Kinds{kClosedSurface}));
  EXPECT_EQ(graph.nodes[0].cavities, 1u);
  EXPECT_EQ(graph.nodes[0].loops, 2u);
  EXPECT_TRUE(graph.edges.empty());
}

TEST(TraceSkeleton, OfASolidBallIsOneIsolatedNodeAtItsMiddle) {
  Points ball;
  const auto radius = [](LatticePoint p) { return std::hypot(p.x - 12, p.y - 12, p.z - 12); };
  for (LatticePoint p : test::RandomCloud(0, {14, 14, 14}, 1)) {
    if (radius(p) <= 10) ball.push_back(p);
  }
  const SkeletonGraph graph =
      Trace(ball, [&](LatticePoint p) { return static_cast<uint16_t>(100 * (11 - radius(p))); });
  EXPECT_EQ(graph.nodes, (std::vector<SkeletonNode>{{kIsolated, {{12, 12, 12}, 1100}, 0, 0}}));
}

TEST(TraceSkeleton, OfASolidTorusIsALoopAlongItsMiddle) {
  Points torus;
  const auto radius = [](LatticePoint p) {
    return std::hypot(std::hypot(p.x - 24, p.y - 24) - 14, p.z - 10);
  };
  for (LatticePoint p : test::RandomCloud(0, {24, 24, 10}, 1)) {
    if (radius(p) <= 6) torus.push_back(p);
  }
  const SkeletonGraph graph =
      Trace(torus, [&](LatticePoint p) { return static_cast<uint16_t>(100 * (7 - radius(p))); });
  EXPECT_EQ(KindsOf(graph), (Kinds{kLoop}));
  ASSERT_EQ(graph.edges.size(), 1u);
  for (LatticePoint p : PathOf(graph, 0)) EXPECT_LE(radius(p), 2.5);
}

TEST(TraceSkeleton, KeepsRadiiAndPlacement) {
  const Points line = Polyline({{4, 4, 4}, {4, 4, 40}});
  const Volume thin = test::VolumeWith(line, {5, 5, 21}, {.spacing = {2, 3, 4}});
  const SkeletonGraph graph =
      TraceSkeleton({thin, test::RadiiOf(thin, test::RuggedDepth)}, {}).value();
  EXPECT_EQ(graph.placement, thin.placement());
  ASSERT_EQ(graph.points.size(), line.size());
  for (const SkeletonPoint& p : graph.points) EXPECT_EQ(p.radius, test::RuggedDepth(p.point));
}

TEST(TraceSkeleton, StopsWhenTheJobIsCancelledOrLate) {
  const Volume volume = VolumeOfPoints(kHexagon);
  const exec::Context context = test::Stopped();
  EXPECT_EQ(TraceSkeleton({volume, test::RadiiOf(volume)}, context).status().code(),
            absl::StatusCode::kCancelled);
  const exec::Context late = test::Late();
  EXPECT_EQ(TraceSkeleton({volume, test::RadiiOf(volume)}, late).status().code(),
            absl::StatusCode::kDeadlineExceeded);
}

}  // namespace
}  // namespace bccskel
