#include <gtest/gtest.h>

#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

SkeletonGraph Star() {
  return test::Trace({{8, 8, 8}, {9, 9, 9}, {10, 10, 10}, {7, 7, 9}, {9, 7, 7}, {7, 9, 7}});
}

TEST(SkeletonDigest, OfTheEmptyGraphIsThatOfItsLayout) {
  // printf 'bccskel.skeleton.v3' and 24 zero bytes | sha256sum
  EXPECT_EQ(*SkeletonDigest({}),
            "2734a63cf036faf00b088449e2bdad46cae6c3a021e14cb67c431deef1dbae12");
}

// The digest was computed from the layout by another program.
TEST(SkeletonDigestGolden, OfAStarStaysTheSame) {
  EXPECT_EQ(*SkeletonDigest(Star()),
            "f59b32d18fcd56b8bf79833b05ba4ba460763a8033729e5f72dc8a1c3e3aca16");
}

TEST(SkeletonDigest, DoesNotDependOnThePlacement) {
  SkeletonGraph graph = Star();
  graph.placement.spacing = {3, 4, 5};
  EXPECT_EQ(*SkeletonDigest(graph), *SkeletonDigest(Star()));
}

TEST(SkeletonDigest, DependsOnEveryNumberOfTheGraph) {
  const auto changed = [](auto change) {
    SkeletonGraph graph = Star();
    change(graph);
    return *SkeletonDigest(graph) != *SkeletonDigest(Star());
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
  EXPECT_TRUE(changed([](SkeletonGraph& g) { g.sheets.push_back({{9, 9, 7}, 2}); }));
}

}  // namespace
}  // namespace bccskel
