#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "client/export/graph_formats.h"
#include "client/export/point_forest.h"
#include "tests/client/export/sample_skeletons.h"
#include "tests/support/volume_where.h"

namespace bccskel::exporting::swc {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

struct Row {
  size_t id;
  int type;
  WorldPoint at;
  double radius;
  int64_t parent;
};

std::vector<Row> RowsOf(const std::string& text) {
  std::vector<Row> rows;
  for (const std::string& line : LinesOf(text)) {
    if (line.starts_with('#')) continue;
    const std::vector<std::string> words = WordsOf(line);
    EXPECT_EQ(words.size(), 7) << line;
    rows.push_back({std::stoul(words[0]),
                    std::stoi(words[1]),
                    {std::stod(words[2]), std::stod(words[3]), std::stod(words[4])},
                    std::stod(words[5]),
                    std::stol(words[6])});
  }
  return rows;
}

size_t RootsOf(const std::vector<Row>& rows) {
  size_t roots = 0;
  for (const Row& row : rows) roots += row.parent == -1;
  return roots;
}

// Nodes, and the points between them: what a lossless tree must hold.
size_t PointsOf(const SkeletonGraph& graph) {
  size_t points = graph.nodes.size();
  for (const SkeletonEdge& edge : graph.edges) {
    points += edge.point_count > 2 ? edge.point_count - 2 : 0;
  }
  return points;
}

std::string RawSwc(const SkeletonGraph& graph) {
  return WriteSwc(graph, std::nullopt, {.sampling = {.step = 0}}).text;
}

double Between(const WorldPoint& a, const WorldPoint& b) {
  return std::hypot(b[0] - a[0], b[1] - a[1], b[2] - a[2]);
}

double CableLength(const std::vector<Row>& rows) {
  double length = 0;
  for (const Row& row : rows) {
    if (row.parent > 0) length += Between(row.at, rows[static_cast<size_t>(row.parent) - 1].at);
  }
  return length;
}

// How often each row is an end of a step.
std::vector<int> DegreesOf(const std::vector<Row>& rows) {
  std::vector<int> degrees(rows.size());
  for (const Row& row : rows) {
    if (row.parent < 0) continue;
    ++degrees[row.id - 1];
    ++degrees[static_cast<size_t>(row.parent) - 1];
  }
  return degrees;
}

// A rod along (1, 2, 3), which the lattice has no direction for.
Sample ObliqueRod(const std::array<double, 3>& spacing) {
  constexpr double kLength = 100, kRadius = 5;
  const double root = std::sqrt(14.0);
  const WorldPoint way = {1 / root, 2 / root, 3 / root};
  const Placement placement = {.spacing = spacing};
  const auto reach = [&](size_t axis) { return static_cast<int32_t>(2 * 100 / spacing[axis]); };
  const auto is_in_rod = [&](int32_t x, int32_t y, int32_t z) {
    WorldPoint p = placement.ToWorld(LatticePoint{x, y, z});
    for (double& coordinate : p) coordinate -= kRadius + 2;
    const double along = Dot(p, way);
    return along >= 0 && along <= kLength && Dot(p, p) - along * along <= kRadius * kRadius;
  };
  Volume object =
      test::VolumeWhere({reach(0) / 2, reach(1) / 2, reach(2) / 2}, is_in_rod, placement);
  SkeletonizeResult result = *Skeletonize(object, {}, {});
  return {std::move(object), std::move(result)};
}

TEST(SwcTest, NumbersItsRowsFromOneAndNamesParentsBeforeTheirChildren) {
  for (const Sample& sample : Samples()) {
    const std::vector<Row> rows = RowsOf(WriteSwc(sample.result.graph).text);
    for (size_t n = 0; n < rows.size(); ++n) {
      EXPECT_EQ(rows[n].id, n + 1);
      EXPECT_TRUE(rows[n].parent == -1 ||
                  (rows[n].parent >= 1 && rows[n].parent < static_cast<int64_t>(rows[n].id)));
      EXPECT_GT(rows[n].radius, 0);
    }
  }
}

TEST(SwcTest, HoldsEveryPointOnceAndATreePerComponent) {
  for (const Sample& sample : Samples()) {
    const std::vector<Row> rows = RowsOf(RawSwc(sample.result.graph));
    EXPECT_EQ(rows.size(), PointsOf(sample.result.graph));
    EXPECT_EQ(RootsOf(rows), sample.result.certificate.skeleton.components);
  }
}

TEST(SwcTest, StepZeroGivesTheStepsOfTheLattice) {
  const std::vector<Row> rows = RowsOf(RawSwc(SampleOf(Shape::kTree).result.graph));
  for (const Row& row : rows) {
    if (row.parent == -1) continue;
    const WorldPoint& from = rows[static_cast<size_t>(row.parent) - 1].at;
    double square = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
      square += (row.at[axis] - from[axis]) * (row.at[axis] - from[axis]);
    }
    EXPECT_TRUE(square == 0.75 || square == 1) << square;  // spacing 1: sqrt(3) / 2 or 1
  }
}

TEST(SwcTest, TheCableOfAnObliqueRodIsAsLongAsTheWayBetweenItsEnds) {
  for (const std::array<double, 3>& spacing :
       {std::array<double, 3>{1, 1, 1}, std::array<double, 3>{0.5, 0.5, 1}}) {
    const Sample rod = ObliqueRod(spacing);
    ASSERT_EQ(rod.result.graph.edges.size(), 1);
    const std::vector<Row> rows = RowsOf(WriteSwc(rod.result.graph).text);
    const double straight = Between(rows.front().at, rows.back().at);
    EXPECT_GT(straight, 80);
    EXPECT_NEAR(CableLength(rows) / straight, 1, 0.01) << spacing[0];
  }
}

TEST(SwcTest, HasTheGraphsJunctionsAndNoOthers) {
  const SkeletonGraph graph = SampleOf(Shape::kTree, 20000).result.graph;
  const std::vector<Row> rows = RowsOf(WriteSwc(graph).text);
  const std::vector<int> degrees = DegreesOf(rows);
  const auto junctions = std::ranges::count(graph.nodes, NodeKind::kJunction, &SkeletonNode::kind);
  EXPECT_GT(junctions, 5);
  EXPECT_EQ(std::ranges::count(rows, 5, &Row::type), junctions);
  for (size_t n = 0; n < rows.size(); ++n) EXPECT_EQ(degrees[n] > 2, rows[n].type == 5) << n;
}

TEST(SwcTest, TheStepSaysHowFarPointsLieApart) {
  const SkeletonGraph graph = SampleOf(Shape::kTorus, 20000).result.graph;
  for (const double step : {1.0, 3.0, 7.5}) {
    const std::vector<Row> rows =
        RowsOf(WriteSwc(graph, std::nullopt, {.sampling = {.step = step}}).text);
    ASSERT_GT(rows.size(), 4);
    for (const Row& row : rows) {
      if (row.parent < 0) continue;
      const double way = Between(row.at, rows[static_cast<size_t>(row.parent) - 1].at);
      EXPECT_NEAR(way, step, 0.2 * step);
    }
  }
}

TEST(SwcTest, WritesNoMoreDigitsThanTheLatticeIsWorth) {
  SkeletonGraph graph = SampleOf(Shape::kTree).result.graph;
  for (const auto& [spacing, decimals] : {std::pair(1.0, 4), std::pair(0.004, 7)}) {
    graph.placement.spacing = {spacing, spacing, spacing};
    for (const std::string& line : LinesOf(WriteSwc(graph).text)) {
      if (line.starts_with('#')) continue;
      for (const std::string& word : WordsOf(line)) {
        const size_t point = word.find('.');
        if (point == word.npos) continue;
        EXPECT_LE(word.size() - point - 1, decimals) << word;
        EXPECT_NE(word.back(), '0') << word;
      }
    }
  }
}

TEST(SwcTest, SaysHowTheResultWasMadeInWhichWorldAndUnit) {
  SkeletonizeResult result;
  result.certificate = {
      .mask = BettiNumbers{1, 2, 0}, .input = {1, 1, 0}, .skeleton = {1, 1, 0}, .sampled = true};
  const auto text_in = [&](const World& world) {
    return WriteSwc(Lollipop(), std::nullopt, {.facts = MethodFactsOf(result, world)}).text;
  };
  EXPECT_THAT(text_in({.axes = "RAS", .unit = "mm"}), HasSubstr("# world: RAS\n# unit: mm\n"));
  EXPECT_THAT(text_in({.axes = "a\rb", .unit = "mm\n1 0 0 0 0 1 -1"}),
              HasSubstr("# world: a b\n# unit: mm 1 0 0 0 0 1 -1\n#"));
  EXPECT_THAT(text_in({}), HasSubstr("# world: unknown\n# unit: unknown\n"));
  EXPECT_THAT(text_in({}), HasSubstr("# check: topology of the sampled object kept, sampling "
                                     "changed loops 2 -> 1\n# curve: smooth\n"));
}

TEST(SwcTest, CutsALoopOnceAndSaysSo) {
  const Document document = WriteSwc(Lollipop(), std::nullopt, {.sampling = {.step = 0}});
  EXPECT_EQ(RowsOf(document.text).size(), 6);
  EXPECT_EQ(RootsOf(RowsOf(document.text)), 2);
  EXPECT_THAT(document.note, HasSubstr("1 loop cut"));
  EXPECT_THAT(document.text, HasSubstr("# " + document.note));
}

TEST(SwcTest, SaysNothingWhereNothingIsLost) {
  EXPECT_THAT(WriteSwc(SampleOf(Shape::kTree).result.graph).note, IsEmpty());
}

TEST(SwcTest, SaysThatAClosedSurfaceIsShownAsAPoint) {
  EXPECT_THAT(WriteSwc(SampleOf(Shape::kHollowBall).result.graph).note,
              HasSubstr("1 closed surface shown as a point"));
}

TEST(SwcTest, MarksEndsAndForksAndGivesWorldUnits) {
  std::multiset<std::tuple<int, double, double>> seen;
  for (const Row& row : RowsOf(RawSwc(Lollipop()))) {
    seen.insert({row.type, row.at[0], row.radius});
  }
  EXPECT_TRUE(seen.contains({6, 10, 2}));  // the end at (0, 0, 0): two lattice units deep
  EXPECT_TRUE(seen.contains({5, 12, 4}));
  EXPECT_TRUE(seen.contains({0, 20, 2}));
}

TEST(SwcTest, BeginsEveryTreeAtItsRoot) {
  for (const Sample& sample : Samples()) {
    const SkeletonGraph& graph = sample.result.graph;
    const TreeOrder order = OrderTrees(graph, {});
    std::vector<uint32_t> roots;
    for (const PointForest::Point& point : PointForestOf(graph, order).points) {
      if (!point.parent.has_value()) roots.push_back(point.node.value());
    }
    EXPECT_EQ(roots, order.roots);
    const WorldPoint root = graph.PositionOf(graph.nodes[roots.front()].at);
    const std::vector<Row> rows = RowsOf(WriteSwc(graph, order, {.sampling = {.step = 0}}).text);
    EXPECT_EQ(rows.front().at, root);
  }
}

TEST(SwcTest, TheThickestNodeIsASoma) {
  const SkeletonGraph& graph = SampleOf(Shape::kTree).result.graph;
  const auto types = [&](RootChoice::Rule rule) {
    std::vector<int> types;
    for (const Row& row : RowsOf(WriteSwc(graph, OrderTrees(graph, {.rule = rule})).text)) {
      EXPECT_EQ(row.type == 1, row.parent == -1 && rule == RootChoice::Rule::kDeepestNode);
      types.push_back(row.type);
    }
    return types;
  };
  EXPECT_EQ(types(RootChoice::Rule::kDeepestNode).front(), 1);
  EXPECT_EQ(types(RootChoice::Rule::kThickestEnd).front(), 6);
  EXPECT_NE(RowsOf(WriteSwc(graph).text).front().type, 1);  // nobody asked for a root
}

TEST(SwcTest, AnEmptyGraphIsAHeader) {
  EXPECT_THAT(RowsOf(WriteSwc(SkeletonGraph()).text), IsEmpty());
}

TEST(PointForestTest, CountsTheLoopsOfTheObject) {
  for (const Sample& sample : Samples()) {
    const PointForest forest =
        PointForestOf(sample.result.graph, OrderTrees(sample.result.graph, {}));
    int64_t stated = 0;
    for (const SkeletonNode& node : sample.result.graph.nodes) stated += node.loops;
    EXPECT_EQ(static_cast<int64_t>(forest.loops_cut) + stated,
              sample.result.certificate.skeleton.loops);
  }
}

}  // namespace
}  // namespace bccskel::exporting::swc
