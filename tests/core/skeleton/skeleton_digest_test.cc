#include <gtest/gtest.h>

#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

SkeletonGraph Star() {
  return test::Trace({{8, 8, 8}, {9, 9, 9}, {10, 10, 10}, {7, 7, 9}, {9, 7, 7}, {7, 9, 7}});
}

TEST(SkeletonDigest, OfTheEmptyGraphIsThatOfItsLayout) {
  // printf 'bccskel.skeleton.v2' and 16 zero bytes | sha256sum
  EXPECT_EQ(SkeletonDigest({}), "46f2c0f3bd1e733d16db648538f35923ce13e042dbb08b3db6afa4d1a70cff6b");
}

// The digest was computed from the layout by another program.
TEST(SkeletonDigestGolden, OfAStarStaysTheSame) {
  EXPECT_EQ(SkeletonDigest(Star()),
            "f3627c8c89ee3f09b8c02469390c67305b7398ddfdbd925b70c3c62f15b0e0cf");
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
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[1].kind = NodeKind::kLoop; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].at.point.y += 2; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].at.radius += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].loops += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.nodes[0].cavities += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.edges[0].target += 1; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.edges.pop_back(); }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.points.back().point.z -= 2; }));
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.points.front().radius += 0.001f; }));
}

}  // namespace
}  // namespace bccskel
