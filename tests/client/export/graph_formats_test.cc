#include "client/export/graph_formats.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "client/export/json.h"
#include "client/export/polylines.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/client/export/sample_skeletons.h"

// What each text format holds. That programs of others read them is tested in tests/integration.

namespace bccskel::exporting {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

size_t CountOf(std::string_view text, std::string_view part) {
  size_t count = 0;
  for (size_t at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++count;
  return count;
}

std::vector<std::string> LinesThatBegin(const std::string& text, std::string_view with) {
  std::vector<std::string> found;
  for (const std::string& line : LinesOf(text)) {
    if (line.starts_with(with)) found.push_back(line);
  }
  return found;
}

TEST(PolylinesTest, NodesComeFirstAndInnerPointsFollow) {
  const Polylines polylines = PolylinesOf(Lollipop());
  EXPECT_EQ(polylines.points.size(), 3 + 1 + 2);
  EXPECT_THAT(polylines.lines, ElementsAre(ElementsAre(0, 3, 1), ElementsAre(1, 4, 5, 1)));
  EXPECT_THAT(polylines.lone_points, ElementsAre(2));
}

TEST(PolylinesTest, FollowSmoothCurves) {
  for (const Sample& sample : Samples()) {
    const SkeletonGraph& graph = sample.result.graph;
    const Polylines polylines = PolylinesOf(graph);
    for (size_t n = 0; n < graph.edges.size(); ++n) {
      std::vector<WorldPoint> places;
      for (size_t point : polylines.lines[n]) places.push_back(polylines.places[point]);
      EXPECT_EQ(places, SmoothCurve(graph, graph.edges[n])) << n;
    }
  }
}

TEST(ObjTest, HasALinePerEdgeAndAPointPerLoneNodeInWorldCoordinates) {
  const std::string obj = ObjText(Lollipop());
  EXPECT_THAT(LinesThatBegin(obj, "v "),
              ElementsAre("v 10 20 30", "v 12 22 32", "v 20 30 40", "v 11 21 31", "v 13 22.5 32.5",
                          "v 13.25 22.25 32.25"));
  EXPECT_THAT(LinesThatBegin(obj, "l "), ElementsAre("l 1 4 2", "l 2 5 6 2"));
  EXPECT_THAT(LinesThatBegin(obj, "p "), ElementsAre("p 3"));
}

TEST(VtpTest, CountsItsPiecesAndNamesItsArrays) {
  const std::string vtp = VtpText(Lollipop());
  EXPECT_THAT(vtp, HasSubstr("NumberOfPoints=\"6\" NumberOfVerts=\"1\" NumberOfLines=\"2\""));
  for (const char* name :
       {"radius", "distance", "node_kind", "lattice", "edge_id", "length", "mean_radius",
        "min_radius", "max_radius", "tortuosity", "connectivity", "offsets"}) {
    EXPECT_THAT(vtp, HasSubstr("Name=\"" + std::string(name) + '"'));
  }
}

TEST(GraphMlTest, HasEveryNodeAndEdgeWithItsData) {
  const std::string graphml = GraphMlText(Lollipop());
  EXPECT_EQ(CountOf(graphml, "<node "), 3);
  EXPECT_EQ(CountOf(graphml, "<edge "), 2);
  EXPECT_THAT(graphml,
              HasSubstr("<node id=\"n0\"><data key=\"kind\">end</data><data key=\"x\">10"
                        "</data><data key=\"y\">20</data><data key=\"z\">30</data>"
                        "<data key=\"radius\">2</data><data key=\"component\">0</data></node>"));
  EXPECT_THAT(graphml, HasSubstr("source=\"n1\" target=\"n1\""));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"mean_radius\">3</data><data key=\"min_radius\">2"
                                 "</data><data key=\"max_radius\">4</data>"
                                 "<data key=\"tortuosity\">1</data>"));
}

SkeletonGraph BornLollipop() {
  SkeletonGraph graph = Lollipop();
  graph.nodes[0].at.birth = 4;
  int32_t birth = 4;
  for (SkeletonPoint& p : graph.points) p.birth = birth++;
  graph.edges[0].pruning_level = 2.5;
  return graph;
}

TEST(Births, AreInEveryFormatOfFigures) {
  SkeletonizeResult result;
  result.graph = BornLollipop();
  EXPECT_THAT(JsonText(result), HasSubstr("\"births\":[4,5,6],"));
  EXPECT_THAT(JsonText(result), HasSubstr("\"birth\":4}"));
  const std::string graphml = GraphMlText(result.graph);
  EXPECT_THAT(graphml, HasSubstr("<data key=\"births\">4 5 6</data>"));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"birth\">4</data>"));
  EXPECT_THAT(VtpText(result.graph), HasSubstr("Name=\"birth\" format=\"ascii\">\n4\n0\n0\n5\n"));
}

TEST(Births, OfNodesAloneAreInEveryFormatOfFigures) {
  SkeletonizeResult result;
  result.graph.nodes = {{NodeKind::kIsolated, {{2, 2, 2}, 1.5f, 3}}};
  EXPECT_THAT(JsonText(result), HasSubstr("\"birth\":3}"));
  const std::string graphml = GraphMlText(result.graph);
  EXPECT_THAT(graphml, HasSubstr("<key id=\"birth\""));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"birth\">3</data>"));
  EXPECT_THAT(VtpText(result.graph), HasSubstr("Name=\"birth\" format=\"ascii\">\n3\n"));
}

SkeletonGraph LollipopWithSheet() {
  SkeletonGraph graph = Lollipop();
  graph.sheets = {{{10, 10, 12}, 5}, {{11, 11, 11}, 6}};
  return graph;
}

TEST(Sheets, AreInTheFormatsThatHoldPoints) {
  SkeletonizeResult result;
  result.graph = LollipopWithSheet();
  EXPECT_THAT(JsonText(result),
              HasSubstr("\"sheets\":{\"points\":[[20,30,42],[21,31,41]],\"radii\":[5,6]}"));
  const std::string vtp = VtpText(result.graph);
  EXPECT_THAT(vtp, HasSubstr("NumberOfPoints=\"8\" NumberOfVerts=\"3\" NumberOfLines=\"2\""));
  EXPECT_THAT(vtp, HasSubstr("2\n5\n6\n</DataArray>"));  // radii, the last ones
  EXPECT_THAT(LinesThatBegin(ObjText(result.graph), "p "), ElementsAre("p 3", "p 7", "p 8"));
  EXPECT_EQ(GraphMlText(result.graph), GraphMlText(Lollipop()));
}

TEST(Births, AreNamedNowhereWhereThereAreNone) {
  SkeletonizeResult result;
  result.graph = Lollipop();
  for (const std::string& text :
       {JsonText(result), GraphMlText(result.graph), VtpText(result.graph)}) {
    EXPECT_THAT(text, Not(HasSubstr("birth")));
  }
}

TEST(PruningLevels, AreInEveryFormatOfFigures) {
  EXPECT_THAT(GraphMlText(BornLollipop()), HasSubstr("<data key=\"pruning_level\">2.5</data>"));
  // Of the isolated point, the stem and the loop.
  EXPECT_THAT(VtpText(BornLollipop()),
              HasSubstr("Name=\"pruning_level\" format=\"ascii\">\n-1\n2.5\n-1\n"));
}

// What a file or a user calls the unit.
constexpr char kWildUnit[] = "m\"m\\ <&\n\xb5";

TEST(JsonTest, EscapesTheWorldAndTheUnit) {
  SkeletonizeResult result;
  result.graph = Lollipop();
  result.method = "a\"b";
  const std::string json = JsonText(result, std::nullopt, {.axes = "R\"AS", .unit = kWildUnit});
  EXPECT_THAT(json, HasSubstr(R"("world":"R\"AS",)"));
  EXPECT_THAT(json, HasSubstr(R"("unit":"m\"m\\ <&\u000a\ufffd",)"));
  EXPECT_THAT(json, HasSubstr(R"("method":"a\"b",)"));
}

TEST(GraphMlTest, EscapesFacts) {
  const std::string graphml =
      GraphMlText(Lollipop(), {.facts = {{"unit", kWildUnit}, {"a\"<", "1"}}});
  EXPECT_THAT(graphml, HasSubstr("<data key=\"graph_unit\">m&quot;m\\ &lt;&amp; \xef\xbf\xbd<"));
  EXPECT_THAT(graphml, HasSubstr("attr.name=\"a&quot;&lt;\""));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"graph_a&quot;&lt;\">1<"));
}

TEST(VtpTest, EscapesTheNamesOfFacts) {
  const std::string vtp = VtpText(Lollipop(), {.facts = {{"a\"<", "1"}}});
  EXPECT_THAT(vtp, HasSubstr("Name=\"a&quot;&lt;\""));
}

TEST(GraphMlTest, StatesTheTopologyOfAClosedSurface) {
  const std::string graphml = GraphMlText(SampleOf(Shape::kHollowBall).result.graph);
  EXPECT_THAT(graphml, HasSubstr("<data key=\"kind\">closed_surface</data>"));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"cavities\">1</data>"));
}

TEST(JsonTest, HoldsGraphCertificateAndDigest) {
  SkeletonizeResult result;
  result.graph = Lollipop();
  result.certificate = {.input = {2, 1, 0}, .skeleton = {2, 1, 0}, .simple_points_left = 7};
  result.object_points = 99;
  result.sha256 = "abc";
  const std::string json = JsonText(result);
  EXPECT_THAT(json, HasSubstr("{\"id\":1,\"kind\":\"junction\",\"position\":[12,22,32],"
                              "\"radius\":4,\"component\":0}"));
  EXPECT_THAT(json, HasSubstr("{\"source\":0,\"target\":1,\"points\":[[10,20,30],[11,21,31],"
                              "[12,22,32]],\"radii\":[2,3,4],"));
  EXPECT_THAT(json, HasSubstr("\"certificate\":{\"input\":{\"components\":2,\"loops\":1,"
                              "\"cavities\":0},\"skeleton\":{\"components\":2,\"loops\":1,"
                              "\"cavities\":0},\"simple_points_left\":7}"));
  EXPECT_THAT(json, HasSubstr("{\"nodes\":1,\"edges\":0,\"ends\":0,\"junctions\":0,\"loops\":0,"
                              "\"cavities\":0,\"length\":0,\"max_radius\":2}],\n\"totals\":"
                              "{\"nodes\":3,\"edges\":2,\"ends\":1,\"junctions\":1,\"loops\":1,"));
  EXPECT_THAT(json, HasSubstr("\"object_points\":99"));
  EXPECT_THAT(json, HasSubstr("\"sha256\":\"abc\""));
}

SkeletonizeResult Prepared() {
  SkeletonizeResult result;
  result.graph = Lollipop();
  result.certificate = {
      .unprepared = BettiNumbers{3, 1, 2}, .input = {2, 1, 0}, .skeleton = {2, 1, 0}};
  result.options.preparing.cavities = CavityFilling::kOn;
  result.preparing = {{PreparingStepKind::kFillCavities, 2, 30, 0}};
  result.object_points = 99;
  result.method = "by hand";
  result.algorithm_version = "7";
  return result;
}

TEST(JsonTest, SaysHowTheResultWasMade) {
  const std::string json = JsonText(Prepared());
  EXPECT_THAT(json, HasSubstr("\"method\":\"by hand\""));
  EXPECT_THAT(json, HasSubstr("\"algorithm_version\":\"7\""));
  EXPECT_THAT(json, HasSubstr("\"cavities\":\"filled\",\"tunnel_width\":0,"));
  EXPECT_THAT(json, HasSubstr("\"thinning\":\"symmetric\",\"kind\":\"curve\","));
  EXPECT_THAT(json, HasSubstr("\"preparing\":[{\"step\":\"fill-cavities\",\"count\":2,"
                              "\"points_added\":30,\"points_removed\":0}]"));
  EXPECT_THAT(json, HasSubstr("\"certificate\":{\"unprepared\":{\"components\":3,"));
  EXPECT_THAT(json, HasSubstr("\"notes\":[\"preparing changed the topology: components 3 -> 2"));
}

TEST(GraphMlTest, SaysHowTheResultWasMade) {
  const std::string graphml = GraphMlText(Lollipop(), {.facts = MethodFactsOf(Prepared())});
  EXPECT_THAT(graphml, HasSubstr("<key id=\"graph_method\" for=\"graph\" attr.name=\"method\""));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"graph_method\">by hand</data>"));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"graph_prepared\">2 cavities filled</data>"));
  EXPECT_THAT(graphml,
              HasSubstr("<data key=\"graph_check\">topology of the prepared object kept, "
                        "preparing changed components 3 -&gt; 2, cavities 2 -&gt; 0</data>"));
}

TEST(ObjTest, SaysHowTheResultWasMade) {
  const std::string obj = ObjText(Lollipop(), {.facts = MethodFactsOf(Prepared())});
  EXPECT_THAT(obj, HasSubstr("\n# method: by hand\n"));
  EXPECT_THAT(obj, HasSubstr("\n# unit: unknown\n"));
  EXPECT_THAT(obj, HasSubstr("\n# check: topology of the prepared object kept, "));
}

TEST(GraphMlTest, GivesEachKeyAnIdentifierOfItsOwn) {
  const std::string graphml = GraphMlText(Lollipop(), {.facts = MethodFactsOf(Prepared())});
  const std::string start = "<key id=\"";
  std::set<std::string> seen;
  for (size_t at = graphml.find(start); at != std::string::npos; at = graphml.find(start, at)) {
    at += start.size();
    const std::string id = graphml.substr(at, graphml.find('"', at) - at);
    EXPECT_TRUE(seen.insert(id).second) << id;
  }
  EXPECT_TRUE(seen.contains("cavities"));
  EXPECT_TRUE(seen.contains("graph_cavities"));
}

TEST(VtpTest, SaysHowTheResultWasMade) {
  const std::string vtp = VtpText(Lollipop(), {.facts = MethodFactsOf(Prepared())});
  EXPECT_THAT(vtp, HasSubstr("<FieldData>\n<DataArray type=\"String\" Name=\"method\" "
                             "NumberOfTuples=\"1\" format=\"ascii\">\n"
                             "98 121 32 104 97 110 100 0\n"));
}

// The stick from node 0 to node 1 hangs on node 0; the loop at node 1 is cut.
TEST(GraphFormatsTest, HoldTheOrderOfTheTrees) {
  const SkeletonizeResult result = Prepared();
  const TreeOrder order =
      OrderTrees(result.graph, {.rule = RootChoice::Rule::kNodes, .nodes = {1}});
  const std::string json = JsonText(result, order);
  EXPECT_THAT(json, HasSubstr("\"component\":0,\"root\":1,\"parent\":1,\"root_distance\":"));
  EXPECT_THAT(json, HasSubstr("\"proximal\":1,\"generation\":0,\"strahler\":1}"));
  EXPECT_THAT(json, HasSubstr("\"closes_loop\":true}"));
  EXPECT_THAT(json, HasSubstr("\"order\":{\"roots\":[1,2],\"loops_cut\":1,"
                              "\"most_generations\":0,\"highest_strahler\":1}"));
  EXPECT_THAT(JsonText(result, OrderTrees(result.graph, {RootChoice::Rule::kDeepestNode})),
              HasSubstr("],\"rule\":\"thickest-node\",\"loops_cut\":1,"));
  const std::string graphml = GraphMlText(result.graph, {.order = order});
  EXPECT_THAT(graphml, HasSubstr("<data key=\"parent\">n1</data>"));
  EXPECT_THAT(graphml, HasSubstr("<data key=\"closes_loop\">true</data>"));
  const std::string vtp = VtpText(result.graph, {.order = order});
  EXPECT_THAT(vtp, HasSubstr("Name=\"strahler\" format=\"ascii\">\n-1\n1\n-1\n"));
  EXPECT_THAT(vtp, HasSubstr("Name=\"along\" format=\"ascii\">\n0\n0\n0\n"));
}

TEST(GraphFormatsTest, AnEmptyGraphIsAValidFile) {
  EXPECT_THAT(VtpText({}), HasSubstr("NumberOfPoints=\"0\""));
  EXPECT_EQ(CountOf(GraphMlText({}), "<node "), 0);
  EXPECT_THAT(LinesThatBegin(ObjText({}), "v "), IsEmpty());
  EXPECT_THAT(JsonText({}), HasSubstr("\"nodes\":[],\n\"edges\":[]"));
}

TEST(GraphFormatsTest, NumbersReadBackToTheSameValue) {
  SkeletonGraph graph = Lollipop();
  graph.placement.spacing = {0.1, 1e-7, 123456.789};
  EXPECT_THAT(ObjText(graph), HasSubstr("v 10.05 20.00000005 61758.3945\n"));
}

}  // namespace
}  // namespace bccskel::exporting
