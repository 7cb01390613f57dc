#include <gtest/gtest.h>

#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

SkeletonGraph Star() {
  return test::Trace({{8, 8, 8}, {9, 9, 9}, {10, 10, 10}, {7, 7, 9}, {9, 7, 7}, {7, 9, 7}});
}

TEST(SkeletonDigest, OfTheEmptyGraphIsThatOfItsLayout) {
  // printf 'bccskel.skeleton.v1\xb5\0\0\0\xd1\0\0\0\xd1\0\0\0' and 16 zero bytes | sha256sum
  EXPECT_EQ(SkeletonDigest({}), "998fb76de362009a61daba0b84e6e8f67dbd318ad71a40be1a584760b6a8c3f0");
}

// The digest was computed from the layout by another program.
TEST(SkeletonDigestGolden, OfAStarStaysTheSame) {
  EXPECT_EQ(SkeletonDigest(Star()),
            "9bf9c38212084ba778a22a77556b8aef3bc3bb49d82a6d1e0307dcd37237fa1c");
}

TEST(SkeletonDigest, DoesNotDependOnThePlacement) {
  SkeletonGraph graph = Star();
  graph.placement.spacing = {3, 4, 5};
  EXPECT_EQ(SkeletonDigest(graph), SkeletonDigest(Star()));
}

TEST(SkeletonDigest, DependsOnEveryNumberOfTheGraph) {
  const auto changed = [](auto change) {
    SkeletonGraph graph = Star();
    change(graph);
    return SkeletonDigest(graph) != SkeletonDigest(Star());
  };
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.weights = kLongChamfer; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[1].kind = NodeKind::kLoop; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].at.point.y += 2; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].at.distance += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].loops += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].cavities += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.edges[0].target += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.edges.pop_back(); }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.points.back().point.z -= 2; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.points.front().distance += 256; }));
}

}  // namespace
}  // namespace bccskel
