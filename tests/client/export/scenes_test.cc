#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "client/export/graph_formats.h"
#include "client/export/labeled_graph.h"
#include "tests/client/export/sample_skeletons.h"

// Formats that programs of pictures open: GLB and Slicer's markups.

namespace bccskel::exporting {
namespace {

using Json = nlohmann::json;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

uint32_t WordAt(const std::string& bytes, size_t at) {
  uint32_t word;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

// The JSON chunk, with the lengths of the file checked.
Json SceneOf(const std::string& glb) {
  EXPECT_EQ(glb.substr(0, 4), "glTF");
  EXPECT_EQ(WordAt(glb, 4), 2);
  EXPECT_EQ(WordAt(glb, 8), glb.size());
  const uint32_t json = WordAt(glb, 12);
  const Json scene = Json::parse(glb.substr(20, json));
  if (scene.contains("buffers")) {
    const size_t binary = scene["buffers"][0]["byteLength"];
    EXPECT_EQ(WordAt(glb, 20 + json), (binary + 3) / 4 * 4);
  }
  return scene;
}

TEST(GlbTest, HasANamedNodeAndATubePerBranch) {
  for (const Sample& sample : Samples()) {
    const SkeletonGraph& graph = sample.result.graph;
    const Json scene = SceneOf(WriteGlb(graph)->text);
    EXPECT_EQ(scene["nodes"].size(), 1 + graph.edges.size());
    EXPECT_EQ(scene.value("meshes", Json::array()).size(), graph.edges.size());
    for (size_t n = 0; n < graph.edges.size(); ++n) {
      EXPECT_EQ(scene["nodes"][n + 1]["name"], "branch " + std::to_string(n));
    }
  }
}

TEST(GlbTest, TubesAreAsThickAsTheObjectAndCornersAreVertices) {
  const SkeletonGraph graph = Lollipop();
  const std::string glb = WriteGlb(graph)->text;
  const Json scene = SceneOf(glb);
  const size_t binary = 20 + WordAt(glb, 12) + 8;
  for (const Json& mesh : scene["meshes"]) {
    const Json& primitive = mesh["primitives"][0];
    const Json& positions = scene["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
    const Json& corners = scene["accessors"][primitive["indices"].get<size_t>()];
    const Json& view = scene["bufferViews"][corners["bufferView"].get<size_t>()];
    for (size_t n = 0; n < corners["count"]; ++n) {
      const size_t at = view["byteOffset"].get<size_t>() + corners["byteOffset"].get<size_t>();
      EXPECT_LT(WordAt(glb, binary + at + 4 * n), positions["count"].get<uint32_t>());
    }
  }
  // The stem runs along (1, 1, 1) from radius 2 to 4.
  const Json& stem = scene["accessors"][0];
  EXPECT_GT(stem["max"][0].get<double>() - stem["min"][0].get<double>(), 2 + 2 + 2);
  EXPECT_LT(stem["max"][0].get<double>() - stem["min"][0].get<double>(), 2 + 2 + 4);
}

// Many short edges side by side.
SkeletonGraph Comb(uint32_t edges) {
  SkeletonGraph graph;
  for (uint32_t n = 0; n < edges; ++n) {
    const auto at = static_cast<int32_t>(4 * n);
    for (const int32_t z : {0, 2}) {
      SkeletonNode node;
      node.kind = NodeKind::kEnd;
      node.at.point = {at, 0, z};
      node.at.radius = 2;
      graph.nodes.push_back(node);
      graph.points.push_back(node.at);
    }
    graph.edges.push_back(
        {.source = 2 * n, .target = 2 * n + 1, .first_point = 2 * n, .point_count = 2});
  }
  return graph;
}

TEST(GlbTest, VeryManyTubesAreOneMeshAndANoteSaysSo) {
  const Document many = *WriteGlb(Comb(20'001)), fewer = *WriteGlb(Comb(20'000));
  EXPECT_THAT(fewer.note, IsEmpty());
  EXPECT_THAT(many.note, HasSubstr("20001 branches are one mesh without their names"));
  const Json scene = SceneOf(many.text), single = SceneOf(fewer.text);
  EXPECT_EQ(single["meshes"].size(), 20'000);
  ASSERT_EQ(scene["meshes"].size(), 1);
  ASSERT_EQ(scene["nodes"].size(), 2);
  EXPECT_EQ(scene["nodes"][1]["name"], "branches");
  const Json& primitive = scene["meshes"][0]["primitives"][0];
  const Json& positions = scene["accessors"][primitive["attributes"]["POSITION"].get<size_t>()];
  const Json& corners = scene["accessors"][primitive["indices"].get<size_t>()];
  const size_t per_tube = single["accessors"][0]["count"];
  EXPECT_EQ(positions["count"], 20'001 * per_tube);
  EXPECT_NEAR(positions["max"][0].get<double>() - positions["min"][0].get<double>(), 40'002, 1);
  std::set<uint32_t> used;
  const size_t binary = 20 + WordAt(many.text, 12) + 8;
  const size_t first = scene["bufferViews"][1]["byteOffset"];
  for (size_t n = 0; n < corners["count"]; ++n) {
    used.insert(WordAt(many.text, binary + first + 4 * n));
  }
  EXPECT_EQ(used.size(), positions["count"].get<size_t>());
  EXPECT_EQ(*used.rbegin() + 1, positions["count"].get<uint32_t>());
}

TEST(GlbTest, TubesOfLabelsHaveTheColorsOfTheLabels) {
  SkeletonizeResult result;
  result.graph = Lollipop();
  LabeledSkeletons three({});
  three.Add(3, 1, result);
  three.Add(5, 1, {});  // preparation may leave nothing
  three.Add(9, 1, result);
  const std::string glb = WriteGlb(three.all().graph, three.Context())->text;
  const Json scene = SceneOf(glb);
  const size_t binary = 20 + WordAt(glb, 12) + 8;
  std::map<std::string, std::set<uint32_t>> colors;  // by the label of the name
  for (size_t n = 0; n < scene["meshes"].size(); ++n) {
    const Json& attributes = scene["meshes"][n]["primitives"][0]["attributes"];
    const Json& color = scene["accessors"][attributes["COLOR_0"].get<size_t>()];
    const std::string name = scene["nodes"][n + 1]["name"];
    for (size_t k = 0; k < color["count"]; ++k) {
      const size_t at = color["byteOffset"].get<size_t>() + 28 * k;
      colors[name.substr(0, 7)].insert(WordAt(glb, binary + at));
    }
  }
  // The linear forms of #b42222 and #77b422.
  EXPECT_THAT(colors["label 3"], ElementsAre(0xff030376));
  EXPECT_THAT(colors["label 9"], ElementsAre(0xff037630));
}

TEST(GlbTest, KeepsItsFigureFarFromTheOrigin) {
  SkeletonGraph graph = Lollipop();
  const Json near = SceneOf(WriteGlb(graph)->text)["accessors"][0]["max"];
  for (double& coordinate : graph.placement.origin) coordinate += 1e9;
  const Json far = SceneOf(WriteGlb(graph)->text)["accessors"][0]["max"];
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(far[axis].get<double>(), near[axis].get<double>(), 1e-4);
  }
}

TEST(GlbTest, RefusesWhatNoFloatHolds) {
  SkeletonGraph graph = Lollipop();
  graph.placement.spacing = {1e40, 1e40, 1e40};
  const absl::Status status = WriteGlb(graph).status();
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(status.message(), "the skeleton's coordinates do not fit a float32");
}

TEST(GlbTest, TurnsTheWorldUnlessItsYPointsUp) {
  const SkeletonGraph graph = Lollipop();
  const Json z_up = SceneOf(WriteGlb(graph)->text)["nodes"][0];
  const Json y_up = SceneOf(WriteGlb(graph, {}, {.axes = kYUp, .unit = {}})->text)["nodes"][0];
  EXPECT_TRUE(z_up.contains("rotation"));
  EXPECT_FALSE(y_up.contains("rotation"));
  EXPECT_EQ(z_up["translation"][1], y_up["translation"][2]);
}

TEST(GlbTest, SaysHowTheResultWasMadeInWhichWorldAndUnit) {
  SkeletonizeResult result;
  result.method = "by \"hand\"";
  const MethodFacts facts = MethodFactsOf(result, {.axes = "RAS", .unit = "mm"});
  const Json scene = SceneOf(WriteGlb(Lollipop(), {.facts = facts})->text);
  const Json& extras = scene["nodes"][0]["extras"];
  EXPECT_EQ(extras["method"], "by \"hand\"");
  EXPECT_EQ(extras["world"], "RAS");
  EXPECT_EQ(extras["unit"], "mm");
  EXPECT_EQ(extras["check"], "topology kept");
}

TEST(GlbTest, NothingIsAnEmptyScene) {
  EXPECT_EQ(SceneOf(WriteGlb(SkeletonGraph())->text)["nodes"].size(), 1);
}

TEST(MarkupsTest, HasACurvePerBranch) {
  const SkeletonGraph graph = Lollipop();
  const Document document = WriteMarkups(graph, {}, {.axes = "RAS", .unit = "mm"});
  EXPECT_THAT(document.note, IsEmpty());
  const Json markups = Json::parse(document.text)["markups"];
  ASSERT_EQ(markups.size(), 2);
  EXPECT_EQ(markups[0]["type"], "Curve");
  EXPECT_EQ(markups[0]["name"], "branch 0");
  EXPECT_EQ(markups[0]["coordinateSystem"], "RAS");
  EXPECT_EQ(markups[0]["coordinateUnits"], "mm");
  EXPECT_THAT(markups[0]["controlPoints"].front()["position"], ElementsAre(10, 20, 30));
  EXPECT_THAT(markups[0]["controlPoints"].back()["position"], ElementsAre(12, 22, 32));
}

TEST(MarkupsTest, ALoopWithoutJunctionIsAClosedCurve) {
  const Document document = WriteMarkups(SampleOf(Shape::kTorus).result.graph, {}, {});
  EXPECT_THAT(document.note, HasSubstr("written as LPS"));
  const Json curve = Json::parse(document.text)["markups"][0];
  EXPECT_EQ(curve["type"], "ClosedCurve");
  EXPECT_NE(curve["controlPoints"].front()["position"], curve["controlPoints"].back()["position"]);
}

TEST(MarkupsTest, AreInMillimetersAsSlicersImagesAre) {
  const std::pair<const char*, double> units[] = {{"um", 1e-3}, {"m", 1e3}, {"mm", 1}};
  const Json plain =
      Json::parse(WriteMarkups(Lollipop(), {}, {.axes = "RAS", .unit = "mm"}).text)["markups"][1];
  for (const auto& [unit, factor] : units) {
    const Document document = WriteMarkups(Lollipop(), {}, {.axes = "RAS", .unit = unit});
    const Json curve = Json::parse(document.text)["markups"][1];
    EXPECT_EQ(curve["coordinateUnits"], "mm");
    const double mm = factor;  // clang 14 captures no structured binding
    const auto times = [mm](const Json& number) { return number.get<double>() * mm; };
    for (size_t n = 0; n < plain["controlPoints"].size(); ++n) {
      for (size_t axis = 0; axis < 3; ++axis) {
        EXPECT_DOUBLE_EQ(curve["controlPoints"][n]["position"][axis].get<double>(),
                         times(plain["controlPoints"][n]["position"][axis]));
      }
    }
    for (size_t n = 0; n < 4; ++n) {
      EXPECT_EQ(curve["measurements"][n]["units"], "mm");
      EXPECT_DOUBLE_EQ(curve["measurements"][n]["value"].get<double>(),
                       times(plain["measurements"][n]["value"]));
    }
    EXPECT_EQ(document.note,
              unit == std::string("mm")
                  ? ""
                  : std::string("the input's unit is ") + unit + "; coordinates are written in mm");
  }
}

TEST(MarkupsTest, SayThatAnUnknownUnitIsTakenForMillimeters) {
  const Document document = WriteMarkups(Lollipop(), {}, {.axes = "LPS", .unit = ""});
  EXPECT_THAT(document.note, HasSubstr("taken for millimeters"));
  EXPECT_FALSE(Json::parse(document.text)["markups"][0].contains("coordinateUnits"));
  EXPECT_THAT(WriteMarkups(Lollipop(), {}, {.axes = "", .unit = "pixel"}).note,
              HasSubstr("written as LPS; the unit 'pixel' is not a known unit of length"));
}

TEST(MarkupsTest, EscapeTheUnit) {
  EXPECT_THAT(WriteMarkups(Lollipop(), {}, {.axes = "RAS", .unit = "a\"b\n"}).text,
              HasSubstr(R"("units":"a\"b\u000a"})"));
}

TEST(MarkupsTest, TurnAWorldThatSlicerDoesNotKnow) {
  const Document document = WriteMarkups(Lollipop(), {}, {.axes = "LAS", .unit = "mm"});
  EXPECT_THAT(document.note, HasSubstr("LAS"));
  const Json markups = Json::parse(document.text)["markups"];
  EXPECT_EQ(markups[0]["coordinateSystem"], "RAS");
  EXPECT_THAT(markups[0]["controlPoints"].front()["position"], ElementsAre(-10, 20, 30));
}

TEST(MarkupsTest, NamesTheLabel) {
  GraphContext context;
  context.labels.of_edges = {5, 18446744073709551615u};
  const Json markups = Json::parse(WriteMarkups(Lollipop(), context, {}).text)["markups"];
  EXPECT_EQ(markups[1]["name"], "label 18446744073709551615 branch 1");
}

}  // namespace
}  // namespace bccskel::exporting
