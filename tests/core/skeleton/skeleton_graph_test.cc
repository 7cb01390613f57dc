#include "core/skeleton/skeleton_graph.h"

#include <gtest/gtest.h>

namespace bccskel {
namespace {

SkeletonGraph OneEdge() {
  SkeletonGraph graph;
  graph.points = {{{0, 0, 0}, 2}, {{1, 1, 1}, 2}, {{3, 1, 1}, 4}};
  graph.edges = {{0, 1, 0, 3}};
  return graph;
}

TEST(SkeletonGraph, RadiusIsTheDistanceInTheWorld) {
  SkeletonGraph graph = OneEdge();
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[0]), 1);  // one D6 step, one cell
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[2]), 2);
  graph.placement.spacing = {1.5, 0.5, 1};  // the shortest edge is the unit
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[2]), 1);
  graph.placement.spacing = {0.1, 0.1, 0.1};
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[0]), 0.1);
}

}  // namespace
}  // namespace bccskel
