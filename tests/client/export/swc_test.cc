#include "client/export/swc.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "client/export/point_forest.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::exporting {
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

// Distinct points of a graph: what a lossless tree must hold.
size_t PointsOf(const SkeletonGraph& graph) {
  std::set<LatticePoint> points;
  for (const SkeletonNode& node : graph.nodes) points.insert(node.at.point);
  for (const SkeletonPoint& p : graph.points) points.insert(p.point);
  return points.size();
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
    const std::vector<Row> rows = RowsOf(WriteSwc(sample.result.graph).text);
    EXPECT_EQ(rows.size(), PointsOf(sample.result.graph));
    EXPECT_EQ(RootsOf(rows), sample.result.certificate.skeleton.components);
  }
}

TEST(SwcTest, StepsAreStepsOfTheLattice) {
  const std::vector<Row> rows = RowsOf(WriteSwc(SampleOf(Shape::kTree).result.graph).text);
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

TEST(SwcTest, CutsALoopOnceAndSaysSo) {
  const SwcDocument document = WriteSwc(Lollipop());
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
              HasSubstr("closed surface(s) shown as a point"));
}

TEST(SwcTest, MarksEndsAndForksAndGivesWorldUnits) {
  std::multiset<std::tuple<int, double, double>> seen;
  for (const Row& row : RowsOf(WriteSwc(Lollipop()).text)) {
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
    const PointForest deepest = PointForestOf(graph);
    std::vector<LatticePoint> wanted;
    for (uint32_t root : order.roots) wanted.push_back(graph.nodes[root].at.point);
    const PointForest forest = PointForestOf(graph, wanted);
    std::vector<LatticePoint> roots;
    for (size_t n = 0; n < forest.points.size(); ++n) {
      if (!forest.parents[n].has_value()) roots.push_back(forest.points[n].point);
    }
    EXPECT_EQ(roots, wanted);
    EXPECT_EQ(forest.points.size(), deepest.points.size());
    EXPECT_EQ(forest.loops_cut, deepest.loops_cut);
    EXPECT_EQ(RowsOf(WriteSwc(graph, order).text).size(), forest.points.size());
  }
}

TEST(SwcTest, AnEmptyGraphIsAHeader) {
  EXPECT_THAT(RowsOf(WriteSwc(SkeletonGraph()).text), IsEmpty());
}

TEST(PointForestTest, CountsTheLoopsOfTheObject) {
  for (const Sample& sample : Samples()) {
    const PointForest forest = PointForestOf(sample.result.graph);
    int64_t stated = 0;
    for (const SkeletonNode& node : sample.result.graph.nodes) stated += node.loops;
    EXPECT_EQ(static_cast<int64_t>(forest.loops_cut) + stated,
              sample.result.certificate.skeleton.loops);
  }
}

}  // namespace
}  // namespace bccskel::exporting
