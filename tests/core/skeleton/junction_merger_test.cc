#include "core/skeleton/junction_merger.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

// Lattice points from one place on, so many steps.
void AddLine(std::vector<LatticePoint>& points, LatticePoint from, LatticePoint step, int count) {
  for (int n = 0; n < count; ++n) {
    points.push_back(from);
    from = from + step;
  }
}

constexpr int32_t kMiddle = 40;

// A line along x with limbs up and down, in turn, at these places.
std::vector<LatticePoint> Comb(const std::vector<int32_t>& places) {
  std::vector<LatticePoint> points;
  AddLine(points, {0, kMiddle, kMiddle}, {2, 0, 0}, 40);
  for (size_t n = 0; n < places.size(); ++n) {
    const int32_t way = n % 2 == 0 ? 2 : -2;
    AddLine(points, {places[n], kMiddle + way, kMiddle}, {0, way, 0}, 10);
  }
  return points;
}

SkeletonGraph Merged(const std::vector<LatticePoint>& points, float radius, double reach) {
  SkeletonGraph graph = test::Trace(points, [&](LatticePoint) { return radius; });
  EXPECT_TRUE(MergeJunctions(reach, {}, graph).ok());
  return graph;
}

int64_t JunctionsOf(const SkeletonGraph& graph) {
  return std::ranges::count(graph.nodes, NodeKind::kJunction, &SkeletonNode::kind);
}

TEST(MergeJunctions, MakesOneNodeOfThoseInOneBall) {
  const auto points = Comb({30, 38});
  EXPECT_EQ(JunctionsOf(Merged(points, 10, 0)), 2);
  const SkeletonGraph merged = Merged(points, 10, 1);
  EXPECT_EQ(JunctionsOf(merged), 1);
  EXPECT_EQ(merged.edges.size(), 4u);
  for (const SkeletonEdge& edge : merged.edges) {
    EXPECT_EQ(edge.pruning_level, std::numeric_limits<double>::infinity());
  }
}

TEST(MergeJunctions, LeavesThoseFartherApart) {
  EXPECT_EQ(JunctionsOf(Merged(Comb({24, 54}), 10, kDefaultJunctionReach)), 2);
  EXPECT_EQ(JunctionsOf(Merged(Comb({30, 38}), 4, kDefaultJunctionReach)), 2);
}

// Sampling moves junctions by a lattice unit; of a ball of radius 6 that decides, of 60 it does
// not.
TEST(MergeJunctions, AllowsForSampling) {
  EXPECT_EQ(JunctionsOf(Merged(Comb({30, 38}), 5.7f, kDefaultJunctionReach)), 1);
  EXPECT_EQ(JunctionsOf(Merged(Comb({30, 38}), 5.5f, kDefaultJunctionReach)), 2);
}

TEST(MergeJunctions, MakesNotOneOfARow) {
  const auto row = Comb({10, 18, 26, 34, 42, 50, 58, 66});
  EXPECT_EQ(JunctionsOf(Merged(row, 5, 0)), 8);
  EXPECT_EQ(JunctionsOf(Merged(row, 6, 1.75)), 4);
}

// Two dendrites leave a soma side by side, within one ball of it.
TEST(MergeJunctions, LeavesThinLimbsOfAThickBody) {
  const auto thin_limbs = [](LatticePoint p) { return p.y == kMiddle ? 20.0f : 3.0f; };
  SkeletonGraph graph = test::Trace(Comb({30, 48}), thin_limbs);
  ASSERT_TRUE(MergeJunctions(kDefaultJunctionReach, {}, graph).ok());
  EXPECT_EQ(JunctionsOf(graph), 2);
  EXPECT_EQ(JunctionsOf(Merged(Comb({30, 48}), 20, kDefaultJunctionReach)), 1);
}

TEST(MergeJunctions, TakesTheDeepest) {
  SkeletonGraph graph = test::Trace(Comb({30, 38}), [](LatticePoint p) {
    return p == LatticePoint{38, kMiddle, kMiddle} ? 11.0f : 10.0f;
  });
  ASSERT_TRUE(MergeJunctions(1, {}, graph).ok());
  const auto junction = std::ranges::find(graph.nodes, NodeKind::kJunction, &SkeletonNode::kind);
  ASSERT_NE(junction, graph.nodes.end());
  EXPECT_EQ(junction->at.point, (LatticePoint{38, kMiddle, kMiddle}));
}

// A limb that leaves the x axis to one side by every second step.
void AddSlanted(std::vector<LatticePoint>& points, LatticePoint from, int32_t way, int32_t side) {
  for (int n = 0; n < 10; ++n) {
    from = from + LatticePoint{way, side, side};
    AddLine(points, from, {2 * way, 0, 0}, 2);
    from = from + LatticePoint{2 * way, 0, 0};
  }
}

// Two limbs that share a part of the x axis, and in which planes they leave it.
enum class Planes : uint8_t { kOne, kTwo };
std::vector<LatticePoint> SharedWay(int32_t shared, Planes planes) {
  std::vector<LatticePoint> points;
  AddLine(points, {kMiddle, kMiddle, kMiddle}, {2, 0, 0}, shared);
  for (const int32_t side : {1, -1}) {
    AddSlanted(points, {kMiddle, kMiddle, kMiddle}, -1, side);
    const size_t first = points.size();
    AddSlanted(points, {kMiddle + 2 * shared - 2, kMiddle, kMiddle}, 1, side);
    if (planes == Planes::kOne) continue;
    for (size_t n = first; n < points.size(); ++n) points[n].z = 2 * kMiddle - points[n].z;
  }
  return points;
}

TEST(MergeJunctions, MakesOneNodeInTheMiddleWhereStraightLimbsCross) {
  const auto points = SharedWay(7, Planes::kOne);
  EXPECT_EQ(JunctionsOf(Merged(points, 6, 0)), 2);
  const SkeletonGraph merged = Merged(points, 6, kDefaultJunctionReach);
  ASSERT_EQ(JunctionsOf(merged), 1);
  EXPECT_EQ(merged.edges.size(), 4u);
  const auto junction = std::ranges::find(merged.nodes, NodeKind::kJunction, &SkeletonNode::kind);
  EXPECT_NEAR(junction->at.point.x, kMiddle + 6, 2);
  EXPECT_TRUE(std::ranges::is_sorted(merged.nodes, {},
                                     [](const SkeletonNode& node) { return node.at.point; }));
  EXPECT_EQ(JunctionsOf(Merged(SharedWay(7, Planes::kTwo), 6, kDefaultJunctionReach)), 2);
  EXPECT_EQ(JunctionsOf(Merged(points, 2, kDefaultJunctionReach)), 2);
}

TEST(MergeJunctions, KeepsTheLevelsOfEdges) {
  SkeletonGraph graph = test::Trace(Comb({30, 38}), [](LatticePoint) { return 10.0f; });
  std::vector<double> levels;
  for (SkeletonEdge& edge : graph.edges) {
    edge.pruning_level = 2 + static_cast<double>(edge.point_count);
    levels.push_back(edge.pruning_level);
  }
  const double between = std::ranges::min(levels);
  ASSERT_TRUE(MergeJunctions(1, {}, graph).ok());
  ASSERT_EQ(graph.edges.size() + 1, levels.size());
  for (const SkeletonEdge& edge : graph.edges) {
    EXPECT_NE(edge.pruning_level, between);
    EXPECT_EQ(std::ranges::count(levels, edge.pruning_level),
              std::ranges::count(graph.edges, edge.pruning_level, &SkeletonEdge::pruning_level));
  }
}

// Two ways from one junction to the other, one of them outside the ball or both in it.
TEST(MergeJunctions, LosesNoLoop) {
  auto points = Comb({30, 46});
  AddLine(points, {32, kMiddle + 20, kMiddle}, {2, 0, 0}, 10);
  AddLine(points, {50, kMiddle, kMiddle + 2}, {0, 0, 2}, 3);
  AddLine(points, {50, kMiddle + 2, kMiddle + 6}, {0, 2, 0}, 10);
  AddLine(points, {50, kMiddle + 20, kMiddle + 4}, {0, 0, -2}, 2);
  for (const float radius : {9.0f, 12.0f, 30.0f}) {
    SCOPED_TRACE(radius);
    const SkeletonGraph apart = Merged(points, radius, 0);
    const SkeletonGraph merged = Merged(points, radius, kDefaultJunctionReach);
    EXPECT_LT(merged.nodes.size(), apart.nodes.size());
    EXPECT_EQ(merged.edges.size() - merged.nodes.size(), apart.edges.size() - apart.nodes.size());
  }
}

// Two junctions with a short way between them and, around a tunnel in the same ball, a long one.
std::vector<LatticePoint> CombWithTunnel(int32_t side) {
  auto points = Comb({30, 46});
  AddLine(points, {30, kMiddle, kMiddle + side}, {0, 0, side}, 6);
  AddLine(points, {32, kMiddle, kMiddle + 6 * side}, {2, 0, 0}, 7);
  AddLine(points, {46, kMiddle, kMiddle + 6 * side}, {0, 0, -side}, 6);
  return points;
}

// Whether the rim of the tunnel is thick or thin: it is no limb that leaves the ball.
TEST(MergeJunctions, TakesTheShortWayAroundATunnel) {
  for (const int32_t side : {-2, 2}) {
    for (const float rim : {20.0f, 1.0f}) {
      SCOPED_TRACE(testing::Message() << side << ", rim of " << rim);
      SkeletonGraph graph = test::Trace(
          CombWithTunnel(side), [&](LatticePoint p) { return p.z == kMiddle ? 20.0f : rim; });
      ASSERT_TRUE(MergeJunctions(kDefaultJunctionReach, {}, graph).ok());
      EXPECT_EQ(JunctionsOf(graph), 1);
      ASSERT_EQ(graph.edges.size(), 5u);
      for (const SkeletonEdge& edge : graph.edges) {
        if (edge.source == edge.target) continue;
        EXPECT_LE(graph.PointsOf(edge).size(), 26u);  // an arm of 18, 8 steps of the short way
      }
    }
  }
}

TEST(MergeJunctions, ChecksItsReach) {
  EXPECT_TRUE(CheckJunctionReach(0).ok());
  EXPECT_TRUE(CheckJunctionReach(kMaxJunctionReach).ok());
  EXPECT_EQ(CheckJunctionReach(-1).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(CheckJunctionReach(std::numeric_limits<double>::quiet_NaN()).code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel
