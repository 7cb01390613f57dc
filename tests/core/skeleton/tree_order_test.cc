#include "core/skeleton/tree_order.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/skeleton/skeleton_figures.h"
#include "tests/core/skeleton/traced.h"

namespace bccskel {
namespace {

using Rule = RootChoice::Rule;

// A straight edge of so many world units.
struct Limb {
  uint32_t source;
  uint32_t target;
  int32_t length;
  float radius = 1;
};

// Nodes lie 10 world units apart in a row. Kinds follow from the edges.
SkeletonGraph GraphOf(uint32_t nodes, const std::vector<Limb>& limbs) {
  SkeletonGraph graph;
  std::vector<int> degrees(nodes);
  for (const Limb& limb : limbs) {
    graph.edges.push_back({.source = limb.source,
                           .target = limb.target,
                           .first_point = graph.points.size(),
                           .point_count = static_cast<uint64_t>(limb.length) + 1});
    for (int32_t n = 0; n <= limb.length; ++n) graph.points.push_back({{0, 0, 2 * n}, limb.radius});
    ++degrees[limb.source];
    ++degrees[limb.target];
  }
  for (uint32_t n = 0; n < nodes; ++n) {
    const NodeKind kind = degrees[n] == 0   ? NodeKind::kIsolated
                          : degrees[n] == 1 ? NodeKind::kEnd
                                            : NodeKind::kJunction;
    graph.nodes.push_back({kind, {{20 * static_cast<int32_t>(n), 0, 0}, 1}});
  }
  return graph;
}

RootChoice Node(uint32_t node) { return {.rule = Rule::kNodes, .nodes = {node}}; }

template <typename Row, typename Value>
std::vector<Value> Column(const std::vector<Row>& rows, Value Row::*value) {
  std::vector<Value> column;
  for (const Row& row : rows) column.push_back(row.*value);
  return column;
}

using Numbers = std::vector<uint32_t>;

// 0 is the trunk's end, 1 forks into the leaf 2 and 3, which forks into the leaves 4 and 5.
SkeletonGraph Tree() {
  return GraphOf(6, {{0, 1, 8, 4}, {1, 2, 3}, {1, 3, 4, 2}, {3, 4, 2}, {3, 5, 5}});
}

TEST(TreeOrderTest, NodesMayBeTheRootsOfTheirComponents) {
  const RootChoice nodes = {.rule = Rule::kNodes, .nodes = {4}};
  EXPECT_TRUE(CheckRootChoice(nodes, Tree()).ok());
  const TreeOrder order = OrderTrees(Tree(), nodes);
  EXPECT_EQ(order.roots, Numbers{4});
  const TreeOrder same = OrderTrees(Tree(), Node(4));
  EXPECT_EQ(Column(order.nodes, &NodeOrder::parent), Column(same.nodes, &NodeOrder::parent));
  EXPECT_FALSE(CheckRootChoice({.rule = Rule::kNodes, .nodes = {4, 6}}, Tree()).ok());
}

TEST(TreeOrderTest, TheDeepestNodeMayBeTheRoot) {
  SkeletonGraph graph = Tree();
  graph.nodes[3].at.radius = 7;
  EXPECT_EQ(OrderTrees(graph, {Rule::kDeepestNode}).roots, Numbers({3}));
}

TEST(TreeOrder, NumbersATreeFromItsTrunk) {
  const TreeOrder order = OrderTrees(Tree(), {});
  EXPECT_EQ(order.roots, Numbers{0});
  EXPECT_EQ(order.loops_cut, 0u);
  EXPECT_EQ(Column(order.edges, &EdgeOrder::proximal), (Numbers{0, 1, 1, 3, 3}));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::generation), (Numbers{0, 1, 1, 2, 2}));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::strahler), (Numbers{2, 1, 2, 1, 1}));
  EXPECT_EQ(Column(order.nodes, &NodeOrder::parent), (Numbers{kNoRow, 0, 1, 1, 3, 3}));
  EXPECT_EQ(Column(order.nodes, &NodeOrder::root_distance),
            (std::vector<double>{0, 8, 11, 12, 14, 17}));
  EXPECT_EQ(order.MostGenerations(), 2u);
  EXPECT_EQ(order.HighestStrahler(), 2u);
}

TEST(TreeOrder, FromALeafTurnsTheEdgesOnTheWay) {
  const TreeOrder order = OrderTrees(Tree(), Node(5));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::proximal), (Numbers{1, 1, 3, 3, 5}));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::generation), (Numbers{2, 2, 1, 1, 0}));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::strahler), (Numbers{1, 1, 2, 1, 2}));
  EXPECT_EQ(order.nodes[0].root_distance, 17);
}

TEST(TreeOrder, FromAForkGivesAllItsEdgesGenerationZero) {
  const TreeOrder order = OrderTrees(Tree(), Node(1));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::generation), (Numbers{0, 0, 0, 1, 1}));
  EXPECT_EQ(Column(order.edges, &EdgeOrder::strahler), (Numbers{1, 1, 2, 1, 1}));
}

// Two of order 2 and one of order 1 give 3; one of order 2 and two of order 1 give 2.
TEST(TreeOrder, StrahlerGrowsOnlyWhereTwoOfTheHighestMeet) {
  const SkeletonGraph graph = GraphOf(12, {{0, 1, 9, 5},
                                           {1, 2, 1},
                                           {1, 3, 1},
                                           {1, 4, 1},
                                           {2, 5, 1},
                                           {2, 6, 1},
                                           {3, 7, 1},
                                           {3, 8, 1},
                                           {8, 9, 1},
                                           {8, 10, 1},
                                           {8, 11, 1}});
  const TreeOrder order = OrderTrees(graph, {});
  EXPECT_EQ(Column(order.edges, &EdgeOrder::strahler), (Numbers{3, 2, 2, 1, 1, 1, 1, 2, 1, 1, 1}));
}

// The way 0-1-3 is shorter than 0-2-3, so the edge 2-3 closes the loop.
TEST(TreeOrder, CutsALoopAtTheEdgeThatIsOnNoShortestWay) {
  const SkeletonGraph graph =
      GraphOf(5, {{0, 1, 2, 9}, {1, 2, 5}, {1, 3, 3}, {2, 3, 4}, {3, 4, 6}, {3, 3, 7}});
  const TreeOrder order = OrderTrees(graph, Node(0));
  EXPECT_EQ(order.loops_cut, 2u);
  EXPECT_TRUE(order.edges[3].ClosesLoop());
  EXPECT_TRUE(order.edges[5].ClosesLoop());
  EXPECT_EQ(order.edges[3].strahler, 0u);
  EXPECT_EQ(order.edges[4].strahler, 1u);
  EXPECT_EQ(order.edges[2].strahler, 1u);  // nothing else leaves node 3
  EXPECT_EQ(order.edges[4].generation, order.edges[2].generation);
  EXPECT_EQ(order.edges[0].strahler, 2u);
}

TEST(TreeOrder, OfTwoEdgesOfOneLengthTakesTheFirst) {
  const TreeOrder order = OrderTrees(GraphOf(3, {{0, 1, 1, 3}, {1, 2, 4}, {1, 2, 4}}), Node(0));
  EXPECT_FALSE(order.edges[1].ClosesLoop());
  EXPECT_TRUE(order.edges[2].ClosesLoop());
}

TEST(TreeOrder, ChoosesARootForEachComponent) {
  const SkeletonGraph graph =
      GraphOf(7, {{0, 1, 2, 1}, {2, 3, 2, 3}, {4, 4, 5}, {3, 5, 2, 4}, {3, 6, 2, 3}});
  EXPECT_EQ(OrderTrees(graph, {}).roots, (Numbers{0, 5, 4}));
  EXPECT_EQ(OrderTrees(graph, Node(6)).roots, (Numbers{0, 6, 4}));
  const RootChoice near = {.rule = Rule::kNearestNode, .point = {34, 1, 1}};
  EXPECT_EQ(OrderTrees(graph, near).roots, (Numbers{1, 3, 4}));
}

TEST(TreeOrder, OfALoneNodeAndOfNothing) {
  const TreeOrder order = OrderTrees(GraphOf(1, {}), {});
  EXPECT_EQ(order.roots, Numbers{0});
  EXPECT_EQ(order.nodes[0].parent, kNoRow);
  EXPECT_TRUE(OrderTrees(SkeletonGraph(), {}).roots.empty());
}

TEST(TreeOrder, RefusesANodeThatIsNotThere) {
  EXPECT_TRUE(CheckRootChoice(Node(5), Tree()).ok());
  EXPECT_EQ(CheckRootChoice(Node(6), Tree()).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_TRUE(CheckRootChoice({}, SkeletonGraph()).ok());
}

TEST(TreeOrder, WarnsOfARootFarFromTheSkeleton) {
  const auto warning = [](double x, double z) {
    const RootChoice near = {.rule = Rule::kNearestNode, .point = {x, 0, z}};
    return RootWarning(near, GraphOf(2, {{0, 1, 8, 3}}));
  };
  EXPECT_EQ(warning(11, 0), "");  // two radii, in the world 1, from the node at x = 10
  EXPECT_EQ(warning(0, 11), "");  // two radii, in the world 3, from the edge's end at z = 8
  EXPECT_NE(warning(11.5, 0), "");
  EXPECT_NE(warning(0, 11.5), "");
  EXPECT_TRUE(warning(1010, 0).starts_with(
      "the root is far from the skeleton, 1000 from the nearest node, 1;"))
      << warning(1010, 0);
  EXPECT_EQ(RootWarning(Node(1), Tree()), "");
  EXPECT_EQ(RootWarning({.rule = Rule::kNearestNode}, SkeletonGraph()), "");
}

// On traced skeletons every edge of the trees leads from its proximal node on, and cuts are the
// loops.
TEST(TreeOrderLaw, CutsAsManyEdgesAsThereAreLoopsAndAddsUpDistances) {
  std::vector<LatticePoint> points;
  for (int32_t n = 0; n < 30; ++n) {
    for (LatticePoint p : {LatticePoint{2 * n, 0, 0},
                           {2 * n, 20, 0},
                           {0, 2 * (n % 11), 0},
                           {40, 2 * (n % 11), 0},
                           {20, 10, 2 * n},
                           {2 * n, 10, 0}}) {
      points.push_back(p);
    }
  }
  const SkeletonGraph graph = test::Trace(points);
  const auto totals = TotalOf(ComponentsOf(graph));
  const TreeOrder order = OrderTrees(graph, {});
  EXPECT_EQ(order.loops_cut, totals.loops);
  ASSERT_GT(order.loops_cut, 0u);
  for (size_t e = 0; e < graph.edges.size(); ++e) {
    if (order.edges[e].ClosesLoop()) continue;
    const SkeletonEdge& edge = graph.edges[e];
    const bool forth = order.edges[e].proximal == edge.source;
    const NodeOrder& near = order.nodes[forth ? edge.source : edge.target];
    const NodeOrder& far = order.nodes[forth ? edge.target : edge.source];
    EXPECT_DOUBLE_EQ(far.root_distance, near.root_distance + FiguresOf(graph, edge).length);
    EXPECT_GE(order.edges[e].strahler, 1u);
  }
}

}  // namespace
}  // namespace bccskel
