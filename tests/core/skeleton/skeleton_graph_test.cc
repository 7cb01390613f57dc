#include "core/skeleton/skeleton_graph.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bccskel {
namespace {

SkeletonGraph OneEdge() {
  SkeletonGraph graph;
  graph.points = {{{0, 0, 0}, 209}, {{1, 1, 1}, 209}, {{3, 1, 1}, 418}};
  graph.edges = {{0, 1, 0, 3}};
  return graph;
}

TEST(SkeletonGraph, LengthIsTheSumOfStepsInTheWorld) {
  SkeletonGraph graph = OneEdge();
  EXPECT_DOUBLE_EQ(graph.LengthOf(graph.edges[0]), (std::sqrt(3.0) + 2) / 2);
  graph.placement.spacing = {2, 4, 6};
  graph.placement.origin = {7, 8, 9};
  EXPECT_DOUBLE_EQ(graph.LengthOf(graph.edges[0]), std::sqrt(1.0 + 4 + 9) + 2);
}

TEST(SkeletonGraph, LengthOfAnEdgeIsThatOfItsOwnPoints) {
  SkeletonGraph graph = OneEdge();
  graph.edges = {{0, 1, 1, 2}};
  EXPECT_DOUBLE_EQ(graph.LengthOf(graph.edges[0]), 1);
}

TEST(SkeletonGraph, RadiusIsTheDistanceInTheWorld) {
  SkeletonGraph graph = OneEdge();
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[0]), 1);  // one D6 step, one cell
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[2]), 2);
  graph.placement.spacing = {0.5, 1, 1.5};
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[2]), 2);
  graph.placement.spacing = {0.1, 0.1, 0.1};
  EXPECT_DOUBLE_EQ(graph.RadiusOf(graph.points[0]), 0.1);
  graph.weights = kLongChamfer;
  EXPECT_DOUBLE_EQ(graph.RadiusOf({{0, 0, 0}, 2911}), 0.1);
}

}  // namespace
}  // namespace bccskel
