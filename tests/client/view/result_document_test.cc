#include "client/view/result_document.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "client/export/json.h"
#include "tests/client/export/sample_skeletons.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::view {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Pair;

constexpr const char* kSmall = R"({
"nodes":[{"kind":"end","position":[0,0,0],"radius":1},
         {"kind":"end","position":[1,1,1.5],"radius":0.5}],
"edges":[{"source":0,"target":1,"points":[[0,0,0],[1,1,1.5]],"radii":[1,0.5],"length":2}],
"certificate":{"input":{"components":1,"loops":0,"cavities":0},
               "skeleton":{"components":1,"loops":0,"cavities":0},"simple_points_left":0},
"object_points":9,"something_new":[null]})";

std::string SmallWith(const std::string& was, const std::string& is) {
  std::string text = kSmall;
  const size_t at = text.find(was);
  return at == text.npos ? "the sample has no " + was : text.replace(at, was.size(), is);
}

TEST(ResultDocumentTest, HoldsWhatTheJsonExportWrote) {
  for (const exporting::Sample& sample : exporting::Samples()) {
    const SkeletonGraph& graph = sample.result.graph;
    const auto document = ParseResultDocument(exporting::JsonText(sample.result));
    ASSERT_TRUE(document.ok()) << document.status();
    ASSERT_EQ(document->nodes.size(), graph.nodes.size());
    ASSERT_EQ(document->edges.size(), graph.edges.size());
    EXPECT_EQ(document->certificate, sample.result.certificate);
    EXPECT_EQ(document->object_points, sample.result.object_points);
    EXPECT_EQ(document->placement, graph.placement);
    ASSERT_EQ(document->sheets.points.size(), graph.sheets.size());
    for (size_t n = 0; n < graph.sheets.size(); ++n) {
      EXPECT_EQ(document->sheets.points[n], graph.PositionOf(graph.sheets[n]));
      EXPECT_EQ(document->sheets.radii[n], graph.RadiusOf(graph.sheets[n]));
    }
    for (size_t n = 0; n < graph.nodes.size(); ++n) {
      EXPECT_EQ(document->nodes[n].position, graph.PositionOf(graph.nodes[n].at));
      EXPECT_EQ(document->nodes[n].radius, graph.RadiusOf(graph.nodes[n].at));
    }
    for (size_t n = 0; n < graph.edges.size(); ++n) {
      EXPECT_EQ(document->edges[n].point_count, graph.PointsOf(graph.edges[n]).size());
      EXPECT_EQ(document->edges[n].source, graph.edges[n].source);
    }
  }
}

TEST(ResultDocumentTest, KnowsHowTheObjectWasPrepared) {
  exporting::Sample sample = exporting::SampleOf(Shape::kTorus);
  sample.result.options.preparing = {.denoise_passes = 2,
                                     .cavities = CavityFilling::kOn,
                                     .join_gaps = 1.25,
                                     .min_component_points = 7,
                                     .min_component_volume = 0.25,
                                     .components = KeptComponents::kLargest,
                                     .tunnel_width = 0.5,
                                     .tunnel_cells = 3};
  const auto document = ParseResultDocument(exporting::JsonText(sample.result));
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_EQ(document->preparing, sample.result.options.preparing);
}

TEST(ResultDocumentTest, OfAnOlderVersionHasNoSheetsAndNoPlacement) {
  const auto document = ParseResultDocument(kSmall);
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_TRUE(document->sheets.points.empty());
  EXPECT_EQ(document->placement, std::nullopt);
  EXPECT_FALSE(document->preparing.Wanted());
  EXPECT_FALSE(ParseResultDocument(SmallWith("\"something_new\"", "\"options\"")).ok());
}

TEST(ResultDocumentTest, IgnoresWhatItDoesNotKnow) {
  const std::string deep = std::string(200000, '[') + std::string(200000, ']');
  EXPECT_TRUE(ParseResultDocument(SmallWith("[null]", deep)).ok());
  const auto document = ParseResultDocument(kSmall);
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_EQ(document->points[1], (WorldPoint{1, 1, 1.5}));
  EXPECT_THAT(*document->text, HasSubstr("\"something_new\":[null]"));
}

TEST(ResultDocumentTest, KnowsWhatPagesHaveInAnotherForm) {
  const std::string text = SmallWith(
      "\"length\":2}", R"("curve":[[0,0,0],[1,1,1]],"length":2},{"source":0,"target":0,"curve":[],)"
                       R"("radii":[1], "points" : [ [0,0,0] ] ,"length":0},)"
                       R"({"source":0,"target":0,"points":[[9,9,9]],"radii":[1],"length":0})");
  const auto document = ParseResultDocument(
      std::string(text).replace(text.find("[null]"), 6, R"(0,"timings":{"a":[1]},"sheets":
      {"points":[],"radii":[]})"));
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_EQ(document->edges.size(), 3u);
  EXPECT_THAT(
      document->not_on_pages,
      ElementsAre("[[0,0,0],[1,1,1.5]]", "[1,0.5]", "[[0,0,0],[1,1,1]]", "[]", "[1]", "[ [0,0,0] ]",
                  "[[9,9,9]]", "[1]", R"({"a":[1]})", R"({"points":[],"radii":[]})"));
  EXPECT_THAT(document->curves, ElementsAre(WorldPoint{0, 0, 0}, WorldPoint{1, 1, 1},
                                            WorldPoint{0, 0, 0}, WorldPoint{9, 9, 9}));
}

TEST(ResultDocumentTest, EdgesWithoutACurveBesideOthersHaveTheirPoints) {
  const auto document = ParseResultDocument(
      SmallWith("\"length\":2}", R"("length":2},{"source":0,"target":0,"points":[[7,7,7]],)"
                                 R"("radii":[1],"births":[4],"curve":[[8,8,8]],"length":0})"));
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_THAT(document->curves,
              ElementsAre(WorldPoint{0, 0, 0}, WorldPoint{1, 1, 1.5}, WorldPoint{8, 8, 8}));
  EXPECT_THAT(document->births, ElementsAre(0, 0, 4));
}

TEST(ResultDocumentTest, OptionsKeepTheirOrder) {
  const auto document = ParseResultDocument(
      SmallWith("\"something_new\":[null]",
                R"("options":{"kind":"curve","b":0.5,"n":-3,"t":true,"l":[1, 2]})"));
  ASSERT_TRUE(document.ok()) << document.status();
  EXPECT_THAT(document->options,
              ElementsAre(Pair("kind", "curve"), Pair("b", "0.5"), Pair("n", "-3"),
                          Pair("t", "true"), Pair("l", "[1, 2]")));
  EXPECT_THAT(ParseResultDocument(kSmall)->options, IsEmpty());
}

TEST(ResultDocumentTest, NamesThePlaceOfADefect) {
  const struct {
    std::string text;
    std::string message;
  } cases[] = {
      {"",
       "not a JSON result of skeletonize or submit: it is empty; `bccskel skeletonize` writes one "
       "with -o result.json"},
      {" \n", "submit: it is empty"},
      {"[]", "submit: it begins with '[', not with '{'; `bccskel skeletonize` writes one"},
      {" 3", "submit: it begins with '3', not with '{'"},
      {"v 0 0 0\n", "submit: it begins with 'v', not with '{'"},
      {"{}", "nodes is not there"},
      {R"({"labels":[{"label":1,"skeleton":{}}]})",
       "holds the skeletons of many labels; have `bccskel labels` write the wanted format, or take "
       "the member \"skeleton\" of one label"},
      {SmallWith("[1,1,1.5],\"radius\"", "[1,1],\"radius\""), "nodes[1].position is not three"},
      {SmallWith("\"radius\":0.5", "\"radius\":\"big\""), "nodes[1].radius is not a finite"},
      {SmallWith("\"radius\":0.5", "\"radius\":-5"), "nodes[1].radius is -5, below 0"},
      {SmallWith("[1,0.5]", "[1,-0.5]"), "edges[0].radii[1] is -0.5, below 0"},
      {SmallWith("\"length\":2}]",
                 "\"length\":2}],\"sheets\":{\"points\":[[0,0,0]],\"radii\":[-1]}"),
       "sheets.radii[0] is -1, below 0"},
      {"\x93NUMPY", "it begins with '\\x93'"},
      {SmallWith("[1,0.5]", "[1]"), "edges[0] is not an edge with points and as many radii"},
      {SmallWith("\"target\":1", "\"target\":2"), "names node 2; there are 2"},
      {SmallWith("\"target\":1", "\"target\":-1"), "edges[0].target is not an integer in range"},
      {SmallWith("\"loops\":0", "\"loops\":0.5"), "certificate.input.loops is not an integer"},
      {SmallWith("\"object_points\":9", "\"points\":9"), "object_points is not there"},
      {SmallWith("\"object_points\":9", "\"order\":{\"roots\":[2]},\"object_points\":9"),
       "order names node 2; there are 2"},
      {SmallWith("\"length\":2", "\"length\":2,\"births\":[1]"),
       "edges[0] is not an edge with as many births"},
      {SmallWith("\"length\":2", "\"length\":2,\"curve\":[[0,0,0]]"),
       "edges[0] is not an edge with a curve of as many points"},
      {SmallWith("\"length\":2", "\"length\":2,\"shifts\":[[0,0,32768],[0,0,0]]"),
       "edges[0].shifts[0][2] is not an integer in range"},
      // also where nothing is kept
      {SmallWith("[null]", "[nul]"), "not a JSON result of skeletonize or submit: byte "},
      {SmallWith("[null]", "[1.2.3]"), "not a JSON result"},
      {SmallWith("[null]", "[1,]"), "not a JSON result"},
      {SmallWith("[null]", "[1"), "not a JSON result"},
      {SmallWith("[null]", "{\"a\"}"), "not a JSON result"},
      {SmallWith("[null]", "1e400"), "not a JSON result"},
      {SmallWith("[null]", "\"\xff\""), "not a JSON result"},
      {SmallWith("[null]", "[[]"), "not a JSON result"},
      {std::string(kSmall) + "{}", "not a JSON result"},
      {std::string(kSmall).substr(0, 100),
       "is incomplete: it breaks off after 100 bytes; copy it again, or make it again with "
       "`bccskel skeletonize`"},
      {R"({"nodes":[{"kind":"en)", "is incomplete: it breaks off after 21 bytes"},
      {R"({"nodes":[]}})", "not a JSON result of skeletonize or submit: byte 13"},
  };
  for (const auto& [text, message] : cases) {
    const absl::Status status = ParseResultDocument(text).status();
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument) << text;
    EXPECT_THAT(std::string(status.message()), HasSubstr(message)) << text;
  }
}

TEST(ResultDocumentTest, ErrorsOfAFileNameIt) {
  const test::TemporaryFolder folder;
  const std::string path = folder.Write("broken.json", "{");
  EXPECT_THAT(std::string(ReadResultDocument(path).status().message()), HasSubstr(path));
  EXPECT_EQ(ReadResultDocument(path + ".none").status().code(), absl::StatusCode::kNotFound);
}

TEST(ResultDocumentTest, AStopEndsReading) {
  std::stop_source stop;
  stop.request_stop();
  EXPECT_TRUE(absl::IsCancelled(ParseResultDocument(kSmall, stop.get_token()).status()));
}

}  // namespace
}  // namespace bccskel::view
