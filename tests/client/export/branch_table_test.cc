#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <sstream>

#include "client/export/graph_formats.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/client/export/sample_skeletons.h"

namespace bccskel::exporting {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

using Row = std::map<std::string, std::string>;

std::vector<std::string> CellsOf(const std::string& line) {
  std::istringstream stream(line + ",");
  std::vector<std::string> cells;
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

std::vector<Row> RowsOf(const std::string& text) {
  const std::vector<std::string> lines = LinesOf(text);
  const std::vector<std::string> names = CellsOf(lines.front());
  std::vector<Row> rows;
  for (size_t n = 1; n < lines.size(); ++n) {
    const std::vector<std::string> cells = CellsOf(lines[n]);
    EXPECT_EQ(cells.size(), names.size()) << lines[n];
    Row& row = rows.emplace_back();
    for (size_t k = 0; k < cells.size(); ++k) row[names[k]] = cells[k];
  }
  return rows;
}

TEST(BranchTableTest, HasARowPerBranchWithItsFigures) {
  for (const Sample& sample : Samples()) {
    const SkeletonGraph& graph = sample.result.graph;
    const std::vector<Row> rows = RowsOf(BranchTableText(graph));
    ASSERT_EQ(rows.size(), graph.edges.size());
    for (size_t n = 0; n < rows.size(); ++n) {
      const EdgeFigures figures = FiguresOf(graph, graph.edges[n]);
      EXPECT_EQ(std::stod(rows[n].at("branch_distance")), figures.length);
      EXPECT_EQ(std::stod(rows[n].at("mean_radius")), figures.mean_radius);
      EXPECT_EQ(std::stod(rows[n].at("min_radius")), figures.min_radius);
      EXPECT_EQ(std::stod(rows[n].at("max_radius")), figures.max_radius);
      EXPECT_EQ(rows[n].at("tortuosity").empty(), !figures.tortuosity.has_value());
      EXPECT_EQ(rows[n].at("branch_id"), std::to_string(n));
    }
  }
}

TEST(BranchTableTest, NamesNodesTheirPlacesAndTheKindOfBranch) {
  const std::vector<Row> rows = RowsOf(BranchTableText(Lollipop()));
  ASSERT_EQ(rows.size(), 2);
  const Row& stem = rows[0];
  EXPECT_EQ(stem.at("skeleton_id"), "0");
  EXPECT_EQ(stem.at("node_id_src") + stem.at("node_id_dst"), "01");
  EXPECT_EQ(stem.at("branch_type"), "1");  // junction to end
  EXPECT_EQ(stem.at("coord_src_x"), "10");
  EXPECT_EQ(stem.at("coord_dst_z"), "32");
  EXPECT_DOUBLE_EQ(std::stod(stem.at("euclidean_distance")), std::sqrt(12));
  EXPECT_EQ(rows[1].at("branch_type"), "2");
  EXPECT_EQ(rows[1].at("euclidean_distance"), "0");
  EXPECT_EQ(RowsOf(BranchTableText(SampleOf(Shape::kTorus).result.graph))[0].at("branch_type"),
            "3");
}

TEST(BranchTableTest, TellsTheLabelAndTheOrderWhereThereAre) {
  const SkeletonGraph graph = Lollipop();
  GraphContext context;
  context.labels = {.of_nodes = {7, 7, 7}, .of_edges = {18446744073709551615u, 7}, .of_sheets = {}};
  context.order = OrderTrees(graph, {});
  const std::vector<Row> rows = RowsOf(BranchTableText(graph, context));
  EXPECT_EQ(rows[0].at("label"), "18446744073709551615");
  EXPECT_EQ(rows[0].at("strahler"), "1");
  EXPECT_EQ(rows[1].at("strahler"), "");  // closes a loop
}

TEST(BranchTableTest, TellsWorldAndUnitInEachRow) {
  const auto table_in = [](const World& world) {
    return BranchTableText(Lollipop(), {.facts = MethodFactsOf(SkeletonizeResult(), world)});
  };
  for (const Row& row : RowsOf(table_in({.axes = "LPS", .unit = "mm"}))) {
    EXPECT_EQ(row.at("world"), "LPS");
    EXPECT_EQ(row.at("unit"), "mm");
  }
  EXPECT_EQ(RowsOf(BranchTableText(Lollipop()))[0].at("unit"), "unknown");
  EXPECT_THAT(table_in({.axes = "a,b", .unit = "5\"\n"}), HasSubstr(",\"a,b\",\"5\"\" \"\n"));
}

TEST(BranchTableTest, AnEmptyGraphIsARowOfNames) {
  EXPECT_THAT(RowsOf(BranchTableText(SkeletonGraph())), IsEmpty());
}

}  // namespace
}  // namespace bccskel::exporting
