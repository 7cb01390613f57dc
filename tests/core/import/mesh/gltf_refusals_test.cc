#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/gltf_scene.h"
#include "tests/core/import/mesh/mesh_bytes.h"
#include "tests/core/import/mesh/mesh_shapes.h"

namespace bccskel {
namespace {

using testing::GltfBox;
using ::testing::HasSubstr;
using testing::Json;
using testing::List;
using testing::Scene;
using testing::SceneOf;
using testing::ToGlb;
using testing::ToGltf;

struct GltfRefusal {
  const char* what;
  void (*damage)(Scene&);
  const char* message;
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};
void PrintTo(const GltfRefusal& refusal, std::ostream* out) { *out << refusal.what; }

class GltfRefusals : public ::testing::TestWithParam<GltfRefusal> {};

TEST_P(GltfRefusals, NameWhatIsWrong) {
  Scene scene = SceneOf(GltfBox());
  GetParam().damage(scene);
  for (const std::string& bytes : {ToGlb(scene), ToGltf(scene)}) {
    const auto mesh = ParseMesh(bytes, "a.glb");
    EXPECT_EQ(mesh.status().code(), GetParam().code) << mesh.status();
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr(GetParam().message));
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GltfRefusals,
    ::testing::Values(
        GltfRefusal{"Version1", [](Scene& s) { s.json["asset"]["version"] = "1.0"; }, "is '1.0'"},
        GltfRefusal{
            "RequiredDraco",
            [](Scene& s) { s.json["extensionsRequired"] = List("KHR_draco_mesh_compression"); },
            "requires the extension KHR_draco_mesh_compression"},
        GltfRefusal{"DracoAlone",
                    [](Scene& s) {
                      s.primitive()["extensions"]["KHR_draco_mesh_compression"] = Json::object();
                      s.json["accessors"][0].erase("bufferView");
                    },
                    "without compression"},
        GltfRefusal{"Meshopt",
                    [](Scene& s) {
                      s.json["bufferViews"][1]["extensions"]["EXT_meshopt_compression"] =
                          Json::object();
                    },
                    "EXT_meshopt_compression is not read"},
        GltfRefusal{"LinesOnly", [](Scene& s) { s.primitive()["mode"] = 3; }, "no triangles"},
        GltfRefusal{"UnknownMode", [](Scene& s) { s.primitive()["mode"] = 7; }, "mode is 7"},
        GltfRefusal{"NoPositions", [](Scene& s) { s.primitive().erase("attributes"); },
                    "has no POSITION"},
        GltfRefusal{
            "Cycle",
            [](Scene& s) {
              s.json["nodes"] = List(Json{{"children", List(1)}}, Json{{"children", List(0)}});
              s.json["scenes"] = List(Json{{"nodes", List(0)}});
            },
            "reached twice"},
        GltfRefusal{"NoSuchNode", [](Scene& s) { s.json["nodes"][0]["children"] = List(5); },
                    "nodes[5], which is not there"},
        GltfRefusal{"NoSuchMesh", [](Scene& s) { s.json["nodes"][0]["mesh"] = 1; }, "meshes[1]"},
        GltfRefusal{"NegativeIndex", [](Scene& s) { s.primitive()["indices"] = -1; }, "is -1"},
        GltfRefusal{"AccessorBeyondItsView", [](Scene& s) { s.json["accessors"][0]["count"] = 9; },
                    "9 elements of 12 bytes"},
        GltfRefusal{"HugeCount",
                    [](Scene& s) { s.json["accessors"][0]["count"] = uint64_t{1} << 40; },
                    "1099511627776 elements"},
        GltfRefusal{"OverflowingCount",
                    [](Scene& s) { s.json["accessors"][0]["count"] = ~uint64_t{0}; },
                    "18446744073709551615"},
        GltfRefusal{"ViewBeyondTheBuffer",
                    [](Scene& s) { s.json["bufferViews"][1]["byteLength"] = 1000; },
                    "beyond its buffer of 240 bytes"},
        GltfRefusal{"ShortStride", [](Scene& s) { s.json["bufferViews"][0]["byteStride"] = 8; },
                    "less than the 12 bytes"},
        GltfRefusal{"IndexOutOfRange", [](Scene& s) { s.binary[96] = 8; },
                    "names point 8 (counted from 0) of 8"},
        GltfRefusal{"FloatIndices",
                    [](Scene& s) { s.json["accessors"][1]["componentType"] = testing::kFloat; },
                    "unsigned integers"},
        GltfRefusal{"NoTriples", [](Scene& s) { s.json["accessors"][1]["count"] = 35; },
                    "has 35 corners"},
        GltfRefusal{"Infinity", [](Scene& s) { s.binary.replace(0, 4, "\0\0\x80\x7f", 4); },
                    "must be finite"},
        GltfRefusal{"HugeSparseAccessor",
                    [](Scene& s) {
                      s.json["accessors"][0] = {{"componentType", testing::kFloat},
                                                {"count", uint64_t{1} << 30},
                                                {"type", "VEC3"},
                                                {"sparse", Json::object()}};
                    },
                    "the limit for a file", absl::StatusCode::kResourceExhausted},
        GltfRefusal{"EndlessInstances",
                    [](Scene& s) {
                      s.json["nodes"] = Json::array();
                      for (int n = 0; n < 3000; ++n) s.json["nodes"].push_back({{"mesh", 0}});
                      Json& primitives = s.json["meshes"][0]["primitives"];
                      for (int n = 0; n < 3000; ++n) primitives.push_back({{"mode", 0}});
                    },
                    "draws its meshes so often", absl::StatusCode::kResourceExhausted}),
    [](const auto& info) { return info.param.what; });

TEST(GltfRefusal, RefusesACutContainer) {
  const std::string bytes = ToGlb(SceneOf(GltfBox()));
  for (size_t size = 4; size < bytes.size(); ++size) {
    EXPECT_EQ(ParseMesh(bytes.substr(0, size), "a.glb").status().code(),
              absl::StatusCode::kInvalidArgument)
        << size;
  }
  std::string version = bytes;
  version[4] = 1;
  EXPECT_THAT(std::string(ParseMesh(version, "a.glb").status().message()),
              HasSubstr("version 1 of the container"));
}

TEST(GltfRefusal, SurvivesDeepNesting) {
  const std::string deep(1'000'000, '[');
  EXPECT_FALSE(ParseMesh("{\"a\":" + deep, "a.gltf").ok());
  const std::string closed = deep + std::string(deep.size(), ']');
  EXPECT_FALSE(
      ParseMesh("{\"asset\":{\"version\":\"2.0\"},\"scene\":" + closed + "}", "a.gltf").ok());
  Scene chain = SceneOf(GltfBox());
  chain.json["nodes"] = Json::array();
  for (int n = 0; n < 20'000; ++n) chain.json["nodes"].push_back({{"children", List(n + 1)}});
  chain.json["nodes"].push_back({{"mesh", 0}});
  const auto mesh = ParseMesh(ToGlb(chain), "a.glb");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, GltfBox());
}

TEST(GltfRefusal, RefusesMoreMarksThanItsLimit) {
  const std::string marks = "{\"a\":[1" + std::string(5'000'000, ',') + "]}";
  EXPECT_EQ(ParseMesh(marks, "a.gltf").status().code(), absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace bccskel
