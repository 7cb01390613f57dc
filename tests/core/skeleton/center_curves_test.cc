#include "core/skeleton/center_curves.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/import/shapes/shapes.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/support/contexts.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

constexpr double kRadius = 9;  // world units
constexpr WorldPoint kAxis = {20.3, 19.6, 0};

// A round bar along z, on a grid whose cells have two units along x and y and `height` along z.
Volume Bar(double height) {
  const Placement placement = {.spacing = {2, 2, height}};
  const auto is_in_bar = [&](int32_t x, int32_t y, int32_t z) {
    const WorldPoint p = placement.ToWorld({x, y, z});
    return z >= 2 && z < 58 && std::hypot(p[0] - kAxis[0], p[1] - kAxis[1]) <= kRadius;
  };
  return test::VolumeWhere({20, 20, 30}, is_in_bar, placement);
}

// A straight edge along z beside the axis.
SkeletonGraph Beside(const Volume& bar) {
  SkeletonGraph graph;
  graph.placement = bar.placement();
  for (int32_t z = 6; z <= 54; z += 2) graph.points.push_back({{22, 22, z}, 6});
  graph.nodes = {{NodeKind::kEnd, graph.points.front()}, {NodeKind::kEnd, graph.points.back()}};
  graph.edges = {{0, 1, 0, graph.points.size()}};
  return graph;
}

double MeanOffset(const SkeletonGraph& graph) {
  double sum = 0;
  const std::vector<WorldPoint> curve = SmoothCurve(graph, graph.edges[0]);
  for (const WorldPoint& p : curve) sum += std::hypot(p[0] - kAxis[0], p[1] - kAxis[1]);
  return sum / static_cast<double>(curve.size());
}

TEST(CenterCurves, PullsACurveToTheMiddle) {
  for (double height : {2.0, 3.0, 5.0}) {
    const Volume bar = Bar(height);
    const auto field = ComputeDistance(bar, DistanceKind::kEuclidean, {});
    SkeletonGraph graph = Beside(bar);
    const double before = MeanOffset(graph);
    EXPECT_GT(before, 2.5);
    ASSERT_TRUE(CenterCurves(bar, *field, {}, graph).ok());
    EXPECT_TRUE(graph.HasShifts());
    EXPECT_LT(MeanOffset(graph), 0.65 * before) << height;
  }
}

TEST(CenterCurves, LeavesNodesWhereTheyAre) {
  const Volume bar = Bar(2);
  const auto field = ComputeDistance(bar, DistanceKind::kEuclidean, {});
  SkeletonGraph graph = Beside(bar);
  ASSERT_TRUE(CenterCurves(bar, *field, {}, graph).ok());
  const std::vector<WorldPoint> curve = SmoothCurve(graph, graph.edges[0]);
  EXPECT_EQ(curve.front(), graph.PositionOf(graph.points.front()));
  EXPECT_EQ(curve.back(), graph.PositionOf(graph.points.back()));
}

TEST(CenterCurves, StopsWhenAsked) {
  const Volume bar = Bar(2);
  const auto field = ComputeDistance(bar, DistanceKind::kEuclidean, {});
  SkeletonGraph graph = Beside(bar);
  graph.points.resize(5000, graph.points.back());
  graph.edges[0].point_count = 5000;
  const exec::Context context = test::Stopped();
  EXPECT_EQ(CenterCurves(bar, *field, context, graph).code(), absl::StatusCode::kCancelled);
}

SkeletonGraph Unshifted(SkeletonGraph graph) {
  for (SkeletonPoint& p : graph.points) p.shift = {0, 0, 0};
  return graph;
}

// How far the curve around the ring is from the plane in which the ring lies, on average.
double OffPlane(const SkeletonGraph& graph, double plane) {
  double sum = 0;
  for (const WorldPoint& p : SmoothCurve(graph, graph.edges[0])) sum += std::abs(p[2] - plane);
  return sum / static_cast<double>(graph.points.size());
}

TEST(CenteredCurves, OfARingLieInItsPlane) {
  const Volume ring = *GenerateShape(Shape::kTorus, {.points = 60'000, .noise = 0});
  const auto result = Skeletonize(ring, {}, {});
  ASSERT_TRUE(result.ok()) << result.status();
  ASSERT_EQ(result->graph.edges.size(), 1u);
  double middle = 0;
  ring.ForEachPoint([&](LatticePoint p) { middle += ring.placement().ToWorld(p)[2]; });
  middle /= static_cast<double>(ring.PointCount());
  EXPECT_LE(OffPlane(result->graph, middle), OffPlane(Unshifted(result->graph), middle));
}

// Whether the place is in the cell of an object point: the nearest, or one of several as near.
bool IsInside(const Volume& object, const std::array<double, 3>& place) {
  std::array<int32_t, 3> low;
  for (size_t axis = 0; axis < 3; ++axis) low[axis] = static_cast<int32_t>(place[axis]) - 1;
  double nearest = 4, inside = 4;
  for (int n = 0; n < 64; ++n) {
    const LatticePoint p = {low[0] + n % 4, low[1] + n / 4 % 4, low[2] + n / 16};
    if (!IsOnLattice(p)) continue;
    const double square =
        std::pow(place[0] - p.x, 2) + std::pow(place[1] - p.y, 2) + std::pow(place[2] - p.z, 2);
    nearest = std::min(nearest, square);
    if (object.Contains(p)) inside = std::min(inside, square);
  }
  return inside < nearest + 1e-9;
}

TEST(CenteredCurves, StayInsideTheObject) {
  for (Shape shape : {Shape::kTree, Shape::kHorse, Shape::kKnot}) {
    const Volume object = *GenerateShape(shape, {.points = 40'000, .noise = 0.05});
    const SkeletonGraph graph = Skeletonize(object, {}, {})->graph;
    const Placement& placement = graph.placement;
    for (const SkeletonEdge& edge : graph.edges) {
      for (const WorldPoint& at : SmoothCurve(graph, edge)) {
        std::array<double, 3> place;
        for (size_t axis = 0; axis < 3; ++axis) {
          place[axis] = (at[axis] - placement.origin[axis]) * 2 / placement.spacing[axis];
        }
        ASSERT_TRUE(IsInside(object, place));
      }
    }
  }
}

TEST(CenteredCurves, AreMadeOfEuclideanDistancesAlone) {
  const Volume object = *GenerateShape(Shape::kTree, {.points = 20'000});
  EXPECT_TRUE(Skeletonize(object, {}, {})->graph.HasShifts());
  for (DistanceKind kind : {DistanceKind::kChamfer, DistanceKind::kChamferOptimal}) {
    EXPECT_FALSE(Skeletonize(object, {.distance = kind}, {})->graph.HasShifts());
  }
}

TEST(CenteredCurves, AreTheSameForAnyThreadCount) {
  const Volume object = *GenerateShape(Shape::kTree, {.points = 40'000});
  const SkeletonGraph expected = Skeletonize(object, {}, {})->graph;
  test::TeamContext context(3);
  EXPECT_EQ(Skeletonize(object, {}, context)->graph, expected);
}

}  // namespace
}  // namespace bccskel
