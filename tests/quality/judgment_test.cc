#include <gtest/gtest.h>

#include <numbers>

#include "tests/quality/hair.h"
#include "tests/quality/sketch.h"
#include "tests/support/reference_mask.h"

namespace bccskel::quality {
namespace {

// Edges along straight lines between nodes, with a point a unit and one radius.
class GraphMaker {
 public:
  GraphMaker() { graph_.placement.spacing = {2, 2, 2}; }

  uint32_t Node(NodeKind kind, LatticePoint at, float radius) {
    graph_.nodes.push_back({kind, {at, radius}});
    return static_cast<uint32_t>(graph_.nodes.size() - 1);
  }
  void Edge(uint32_t source, uint32_t target, const std::vector<LatticePoint>& corners,
            float radius) {
    SkeletonEdge edge = {source, target, graph_.points.size()};
    LatticePoint p = corners.front();
    graph_.points.push_back({p, radius});
    for (const LatticePoint& corner : corners) {
      while (p != corner) {
        const auto step = [](int32_t from, int32_t to) { return (to > from) - (to < from); };
        p = p + LatticePoint{step(p.x, corner.x), step(p.y, corner.y), step(p.z, corner.z)};
        graph_.points.push_back({p, radius});
      }
    }
    edge.point_count = graph_.points.size() - edge.first_point;
    graph_.edges.push_back(edge);
  }
  const SkeletonGraph& graph() const { return graph_; }

 private:
  SkeletonGraph graph_;
};

// A limb of a radius of 10 that forks into two strands inside it, 100 long.
GraphMaker Strands(NodeKind far) {
  GraphMaker maker;
  const uint32_t start = maker.Node(NodeKind::kEnd, {0, 0, 0}, 10);
  const uint32_t fork = maker.Node(NodeKind::kJunction, {100, 0, 0}, 10);
  const uint32_t end = maker.Node(far, {200, 0, 0}, 10);
  maker.Edge(start, fork, {{0, 0, 0}, {100, 0, 0}}, 10);
  maker.Edge(fork, end, {{100, 0, 0}, {200, 0, 0}}, 10);
  const bool loop = far == NodeKind::kJunction;
  const uint32_t other = loop ? end : maker.Node(NodeKind::kEnd, {200, 6, 0}, 10);
  std::vector<LatticePoint> path = {{100, 0, 0}, {106, 6, 0}, {200, 6, 0}};
  if (loop) path.push_back({200, 0, 0});
  maker.Edge(fork, other, path, 10);
  return maker;
}

TEST(Hair, CountsStrandsOfOneLimb) {
  EXPECT_NEAR(HairOf(Strands(NodeKind::kEnd).graph()).redundant_length, 0.6, 0.05);
}

TEST(Hair, LeavesLoopsOfTheObject) {
  EXPECT_EQ(HairOf(Strands(NodeKind::kJunction).graph()).redundant_length, 0);
}

// Near its trunk a straight limb lies in balls of the trunk more than two radii away along both,
// if the sine of half the angle is less than 0.45.
TEST(Hair, CountsStraightLimbsThatLeaveAtNarrowAngles) {
  for (const int32_t x : {0, 200}) {
    GraphMaker maker;
    const uint32_t middle = maker.Node(NodeKind::kJunction, {0, 0, 0}, 40);
    for (const int32_t end : {-300, 300}) {
      maker.Edge(middle, maker.Node(NodeKind::kEnd, {end, 0, 0}, 40), {{0, 0, 0}, {end, 0, 0}}, 40);
    }
    maker.Edge(middle, maker.Node(NodeKind::kEnd, {x, 200, 0}, 3), {{0, 0, 0}, {x, 200, 0}}, 3);
    const double redundant = HairOf(maker.graph()).redundant_length;
    EXPECT_NEAR(redundant, x == 0 ? 0 : 0.025, 0.01) << x;
  }
}

TEST(Hair, TellsTwigsFromLimbs) {
  for (const int32_t length : {5, 12, 20}) {
    GraphMaker maker;
    const uint32_t middle = maker.Node(NodeKind::kJunction, {0, 0, 0}, 10);
    for (const int32_t x : {-100, 100}) {
      maker.Edge(middle, maker.Node(NodeKind::kEnd, {x, 0, 0}, 10), {{0, 0, 0}, {x, 0, 0}}, 10);
    }
    maker.Edge(middle, maker.Node(NodeKind::kEnd, {0, length, 0}, 3), {{0, 0, 0}, {0, length, 0}},
               3);
    const Hair hair = HairOf(maker.graph());
    EXPECT_EQ(hair.twigs, length < 13 ? 1 : 0) << length;
    EXPECT_LT(hair.redundant_length, 1e-9);
  }
}

TEST(MissedParts, AreFartherThanFourVoxelsFromAllBalls) {
  for (const int32_t gap : {3, 12}) {
    VoxelMask mask({.nx = 80, .ny = 12, .nz = 12});
    for (int32_t x = 0; x < 80; ++x) {
      for (int32_t y = 4; y < 8; ++y) {
        for (int32_t z = 4; z < 8; ++z) mask.Flip({x, y, z});
      }
    }
    GraphMaker maker;
    maker.Edge(maker.Node(NodeKind::kEnd, {2, 5, 5}, 2),
               maker.Node(NodeKind::kEnd, {78 - gap, 5, 5}, 2), {{2, 5, 5}, {78 - gap, 5, 5}}, 2);
    EXPECT_EQ(CountMissedParts(maker.graph(), mask), gap > 4 ? 1 : 0) << gap;
  }
}

TEST(Sketch, HasAsManyPointsAsItsVolumeSays) {
  const Vector middle = {40, 40, 40};
  const double pi = std::numbers::pi;
  const Piece flat = {middle, middle, 30, 30, 3, shapes::Unit({1, 2, 2})};
  Piece cut = {{40, 40, 10}, {40, 40, 70}, 20, 10};
  cut = Reversed(CutAtEnd(Reversed(CutAtEnd(cut))));
  const Piece block = {{10.3, 40.4, 40.4}, {70.3, 40.4, 40.4}, 20, 20, 4, {0, 0, 1}, true};
  const std::pair<Piece, double> solids[] = {
      {flat, 4 * pi / 9 * 27000}, {cut, 60 * pi / 3 * (400 + 200 + 100)}, {block, 60 * 40 * 10}};
  for (const auto& [piece, volume] : solids) {
    const Sketch sketch{.pieces = {piece}};
    EXPECT_NEAR(4.0 * static_cast<double>(CountPoints(sketch, Grid::kBcc)), volume, 0.06 * volume);
    EXPECT_NEAR(static_cast<double>(CountPoints(sketch, Grid::kCubic)), volume, 0.06 * volume);
  }
}

TEST(VoxelNoise, KeepsTheTopology) {
  const Sketch ring{.pieces = {{{8, 8, 8}, {28, 8, 8}, 3, 3},
                               {{28, 8, 8}, {28, 28, 8}, 3, 3},
                               {{28, 28, 8}, {8, 28, 8}, 3, 3},
                               {{8, 28, 8}, {8, 8, 8}, 3, 3}}};
  const VoxelMask clean = SampleOnVoxels(ring);
  const VoxelMask noisy = WithTopologyKeepingNoise(clean, 0.3, 1);
  int changed = 0;
  const auto is_in = [&](int32_t x, int32_t y, int32_t z) {
    changed += noisy.Holds({x, y, z}) != clean.Holds({x, y, z}) ? 1 : 0;
    return noisy.Holds({x, y, z});
  };
  const MaskGrid& grid = clean.grid();
  const auto reference = test::MaskWhere(grid.nx, grid.ny, grid.nz, is_in);
  EXPECT_GT(changed, 200);
  EXPECT_EQ(test::ReferenceMaskBetti(reference, test::ObjectReach::kCorner26),
            (BettiNumbers{1, 1, 0}));
}

}  // namespace
}  // namespace bccskel::quality
