#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

#include "client/export/graphml.h"
#include "client/export/json.h"
#include "client/export/obj.h"
#include "client/export/polylines.h"
#include "client/export/vtp.h"
#include "tests/client/export/sample_skeletons.h"

// What each text format holds. That programs of others read them is tested in tests/integration.

namespace bccskel::exporting {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

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
  EXPECT_THAT(polylines.lone_nodes, ElementsAre(2));
}

TEST(ObjTest, HasALinePerEdgeAndAPointPerLoneNodeInWorldCoordinates) {
  const std::string obj = ObjText(Lollipop());
  EXPECT_THAT(LinesThatBegin(obj, "v "), ElementsAre("v 10 20 30", "v 12 22 32", "v 20 30 40",
                                                     "v 11 21 31", "v 13 23 33", "v 14 22 32"));
  EXPECT_THAT(LinesThatBegin(obj, "l "), ElementsAre("l 1 4 2", "l 2 5 6 2"));
  EXPECT_THAT(LinesThatBegin(obj, "p "), ElementsAre("p 3"));
}

TEST(VtpTest, CountsItsPiecesAndNamesItsArrays) {
  const std::string vtp = VtpText(Lollipop());
  EXPECT_THAT(vtp, HasSubstr("NumberOfPoints=\"6\" NumberOfVerts=\"1\" NumberOfLines=\"2\""));
  for (const char* name :
       {"radius", "distance", "node_kind", "smooth", "edge_id", "length", "mean_radius",
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
