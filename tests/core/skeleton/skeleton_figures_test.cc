#include "core/skeleton/skeleton_figures.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "core/lattice/directions.h"
#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

// The lattice path that stays closest to a line from the origin.
std::vector<LatticePoint> Staircase(double dx, double dy, double dz, int steps) {
  std::vector<LatticePoint> path = {{0, 0, 0}};
  for (int n = 0; n < steps; ++n) {
    LatticePoint best = path.back();
    double best_score = 1e9;
    for (LatticePoint offset : kDirections14) {
      const LatticePoint q = path.back() + offset;
      const double t = (q.x * dx + q.y * dy + q.z * dz) / (dx * dx + dy * dy + dz * dz);
      if (offset.x * dx + offset.y * dy + offset.z * dz <= 0) continue;
      const double off = std::hypot(q.x - t * dx, q.y - t * dy, q.z - t * dz);
      if (off < best_score) {
        best = q;
        best_score = off;
      }
    }
    path.push_back(best);
  }
  return path;
}

SkeletonGraph OneEdge(const std::vector<LatticePoint>& path) {
  SkeletonGraph graph;
  float radius = 1;
  for (LatticePoint p : path) graph.points.push_back({p, radius++});
  graph.nodes = {{NodeKind::kEnd, graph.points.front()}, {NodeKind::kEnd, graph.points.back()}};
  graph.edges = {{0, 1, 0, path.size()}};
  return graph;
}

TEST(EdgeFigures, LengthHasNoStaircaseBias) {
  for (const auto& d : {std::array{3.0, 1.0, 1.0}, std::array{5.0, 2.0, 1.0},
                        std::array{2.0, 2.0, 1.0}, std::array{1.0, 1.0, 1.0}}) {
    SkeletonGraph graph = OneEdge(Staircase(d[0], d[1], d[2], 100));
    const LatticePoint end = graph.points.back().point;
    const double straight = std::hypot(end.x, end.y, end.z) / 2;
    for (SkeletonPoint& p : graph.points) p.radius = 10;
    const EdgeFigures figures = FiguresOf(graph, graph.edges[0]);
    EXPECT_GE(figures.length, straight * (1 - 1e-12));
    EXPECT_LT(figures.length, straight * 1.02);
    EXPECT_NEAR(*figures.tortuosity, figures.length / straight, 1e-12);
  }
}

// The middle of a limb of an even by an odd number of voxels lies between lattice points, and the
// points of its curve run around it.
TEST(EdgeFigures, LengthIsThatOfTheLineThatPointsRunAround) {
  std::vector<LatticePoint> path = {{0, 0, 0}};
  for (int turn = 0; turn < 200; ++turn) {
    for (const LatticePoint& step : {LatticePoint{1, -1, 1}, {1, 1, 1}, {1, 1, -1}, {1, -1, -1}}) {
      path.push_back(path.back() + step);
    }
  }
  SkeletonGraph graph = OneEdge(path);
  for (SkeletonPoint& p : graph.points) p.radius = 3;
  EXPECT_NEAR(*FiguresOf(graph, graph.edges[0]).tortuosity, 1, 0.003);
}

TEST(EdgeFigures, AreInWorldUnits) {
  SkeletonGraph graph = OneEdge({{0, 0, 0}, {0, 0, 2}, {0, 0, 4}});
  graph.placement.spacing = {2, 3, 4};
  const EdgeFigures figures = FiguresOf(graph, graph.edges[0]);
  EXPECT_DOUBLE_EQ(figures.length, 8);
  EXPECT_DOUBLE_EQ(figures.min_radius, 1);
  EXPECT_DOUBLE_EQ(figures.mean_radius, 2);
  EXPECT_DOUBLE_EQ(figures.max_radius, 3);
  EXPECT_DOUBLE_EQ(*figures.tortuosity, 1);
}

// A digital circle: the points of a ring nearest to it, one after the other.
TEST(EdgeFigures, OfAClosedCurveAreItsCircumference) {
  constexpr double kRadius = 40;
  std::vector<LatticePoint> ring;
  for (int n = 0; n < 4000; ++n) {
    const double angle = 2 * std::numbers::pi * n / 4000;
    const double x = 50 + kRadius * std::cos(angle), y = 50 + kRadius * std::sin(angle);
    LatticePoint best;
    double nearest = 1e9;
    for (int z : {0, 1}) {
      const int i = 2 * static_cast<int>(std::lround((x - z) / 2)) + z,
                j = 2 * static_cast<int>(std::lround((y - z) / 2)) + z;
      const double off = std::hypot(i - x, j - y, z - 0.5);
      if (off < nearest) {
        best = {i, j, z};
        nearest = off;
      }
    }
    if (ring.empty() || ring.back() != best) ring.push_back(best);
  }
  if (ring.front() != ring.back()) ring.push_back(ring.front());
  SkeletonGraph graph;
  for (LatticePoint p : ring) graph.points.push_back({p, 10});
  graph.nodes = {{NodeKind::kLoop, graph.points.front()}};
  graph.edges = {{0, 0, 0, ring.size()}};
  const EdgeFigures figures = FiguresOf(graph, graph.edges[0]);
  EXPECT_NEAR(figures.length / (std::numbers::pi * kRadius), 1, 0.02);
  EXPECT_FALSE(figures.tortuosity.has_value());
}

TEST(SmoothCurve, StaysWithinHalfTheRadiusOrTheCellOfItsPoints) {
  SkeletonGraph graph = OneEdge(Staircase(5, 2, 1, 60));
  for (const float radius : {0.1f, 1.0f, 8.0f}) {
    for (SkeletonPoint& p : graph.points) p.radius = radius;
    const std::vector<WorldPoint> curve = SmoothCurve(graph, graph.edges[0]);
    ASSERT_EQ(curve.size(), graph.points.size());
    EXPECT_EQ(curve.front(), graph.PositionOf(graph.points.front()));
    EXPECT_EQ(curve.back(), graph.PositionOf(graph.points.back()));
    for (size_t n = 0; n < curve.size(); ++n) {
      const WorldPoint p = graph.PositionOf(graph.points[n]);
      std::array<double, 3> way;
      for (size_t axis = 0; axis < 3; ++axis) way[axis] = std::abs(curve[n][axis] - p[axis]);
      if (std::hypot(way[0], way[1], way[2]) <= graph.RadiusOf(graph.points[n]) / 2) continue;
      EXPECT_LE(std::ranges::max(way), 0.5 + 1e-12);  // a lattice unit
      EXPECT_LE(way[0] + way[1] + way[2], 0.75 + 1e-12);
    }
  }
}

TEST(GraphComponents, CountWhatEachPieceHolds) {
  // A star of four arms, a hexagon and a point.
  SkeletonGraph graph = test::Trace({{8, 8, 8},
                                     {9, 9, 9},
                                     {10, 10, 10},
                                     {7, 7, 9},
                                     {9, 7, 7},
                                     {7, 9, 7},
                                     {26, 28, 28},
                                     {27, 27, 29},
                                     {28, 26, 28},
                                     {29, 27, 27},
                                     {28, 28, 26},
                                     {27, 29, 27},
                                     {40, 40, 40}});
  const GraphComponents components = ComponentsOf(graph);
  ASSERT_EQ(components.figures.size(), 3u);
  EXPECT_EQ(components.figures[0].ends, 4u);
  EXPECT_EQ(components.figures[0].junctions, 1u);
  EXPECT_EQ(components.figures[0].loops, 0u);
  EXPECT_EQ(components.figures[1].loops, 1u);
  EXPECT_EQ(components.figures[2].nodes, 1u);
  const ComponentFigures total = TotalOf(components);
  EXPECT_EQ(total.nodes, graph.nodes.size());
  EXPECT_EQ(total.edges, graph.edges.size());
  EXPECT_EQ(total.loops, 1u);
  EXPECT_DOUBLE_EQ(total.length, components.figures[0].length + components.figures[1].length);
}

TEST(GraphComponents, OfNothingAreNone) {
  EXPECT_TRUE(ComponentsOf({}).figures.empty());
  EXPECT_EQ(TotalOf({}).length, 0);
}

}  // namespace
}  // namespace bccskel
