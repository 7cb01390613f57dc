#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/gltf_scene.h"
#include "tests/core/import/mesh/mesh_bytes.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

using testing::GltfBox;
using ::testing::HasSubstr;
using testing::Json;
using testing::List;
using testing::Scene;
using testing::SceneOf;
using testing::ToGlb;

void ExpectMesh(const std::string& bytes, const TriangleMesh& expected) {
  const auto mesh = ParseMesh(bytes, "a.bin");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, expected);
}

TEST(GltfReader, ReadsBothContainers) {
  ExpectMesh(testing::ToGltf(SceneOf(GltfBox())), GltfBox());
  ExpectMesh(ToGlb(SceneOf(GltfBox())), GltfBox());
}

TEST(GltfReader, ReadsIndicesOfEveryWidthAndNone) {
  const TriangleMesh box = GltfBox();
  for (const auto& [bytes, type] :
       {std::pair(testing::BytesOf(testing::CornersOf<uint8_t>(box)), testing::kUint8),
        std::pair(testing::BytesOf(testing::CornersOf<uint16_t>(box)), testing::kUint16)}) {
    Scene scene = SceneOf(box);
    scene.primitive()["indices"] = scene.AddAccessor(bytes, type, 36, "SCALAR");
    ExpectMesh(ToGlb(scene), box);
  }
  Scene unshared = SceneOf(testing::Unshared(box));
  unshared.primitive().erase("indices");
  ExpectMesh(ToGlb(unshared), testing::Unshared(box));
}

TEST(GltfReader, ReadsInterleavedPoints) {
  const TriangleMesh box = GltfBox();
  std::string bytes = "????";
  for (const auto& v : box.vertices) {
    bytes += testing::BytesOf(std::vector<float>{static_cast<float>(v[0]), static_cast<float>(v[1]),
                                                 static_cast<float>(v[2]), 9, 9});
  }
  Scene scene = SceneOf(box);
  scene.json["accessors"][0]["bufferView"] = scene.AddView(bytes, {{"byteStride", 20}});
  scene.json["accessors"][0]["byteOffset"] = 4;
  ExpectMesh(ToGlb(scene), box);
}

TEST(GltfReader, ReadsQuantizedPoints) {
  const TriangleMesh box = testing::Box({-1, -1, 0}, {1, 1, 1});
  const auto coordinates = testing::CoordinatesOf<int16_t>(box);
  Scene plain = SceneOf(box);
  plain.json["extensionsRequired"] = List("KHR_mesh_quantization");
  plain.json["accessors"][0]["componentType"] = testing::kInt16;
  plain.json["accessors"][0]["bufferView"] = plain.AddView(testing::BytesOf(coordinates));
  ExpectMesh(ToGlb(plain), box);

  std::vector<int8_t> bytes;
  for (const int16_t value : coordinates)
    bytes.push_back(static_cast<int8_t>(value < 0 ? -128 : 127 * value));
  Scene normalized = SceneOf(box);
  normalized.json["accessors"][0]["componentType"] = testing::kByte;
  normalized.json["accessors"][0]["normalized"] = true;
  normalized.json["accessors"][0]["bufferView"] = normalized.AddView(testing::BytesOf(bytes));
  ExpectMesh(ToGlb(normalized), box);
}

TEST(GltfReader, ReplacesSparseElements) {
  TriangleMesh box = GltfBox();
  Scene scene = SceneOf(box);
  const size_t places = scene.AddView(testing::BytesOf(std::vector<uint8_t>{7, 1}));
  const size_t values = scene.AddView(testing::BytesOf(std::vector<float>{10, 11, 12, -3, -2, -1}));
  scene.json["accessors"][0]["sparse"] = {
      {"count", 2},
      {"indices", {{"bufferView", places}, {"componentType", testing::kUint8}}},
      {"values", {{"bufferView", values}}}};
  box.vertices[7] = {10, 11, 12};
  box.vertices[1] = {-3, -2, -1};
  ExpectMesh(ToGlb(scene), box);
}

// Two triangles of a square, as a list.
TriangleMesh Square() {
  return {{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}};
}

TEST(GltfReader, ReadsStripsAndFans) {
  Scene fan = SceneOf(Square());
  fan.primitive().erase("indices");
  fan.primitive()["mode"] = 6;
  ExpectMesh(ToGlb(fan), Square());

  Scene strip = SceneOf(Square());
  strip.primitive()["mode"] = 5;
  strip.primitive()["indices"] = strip.AddAccessor(
      testing::BytesOf(std::vector<uint8_t>{1, 2, 0, 3}), testing::kUint8, 4, "SCALAR");
  const auto mesh = ParseMesh(ToGlb(strip), "a.glb");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_THAT(mesh->triangles, ::testing::ElementsAre(TriangleMesh::Triangle{1, 2, 0},
                                                      TriangleMesh::Triangle{0, 2, 3}));
}

TEST(GltfReader, MovesMeshesByTheirNodesAndTurnsMirroredOnes) {
  Scene scene = SceneOf(Square());
  // A quarter turn about z, twice as large, then shifted; below, a shift as a matrix.
  const double half = std::sqrt(0.5);
  scene.json["nodes"] = {
      {{"children", {1, 2}},
       {"rotation", {0, 0, half, half}},
       {"scale", {2, 2, 2}},
       {"translation", {10, 0, 0}}},
      {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 5, 1}}},
      {{"mesh", 0}, {"scale", {1, 1, -1}}}};
  const auto mesh = ParseMesh(ToGlb(scene), "a.glb");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  ASSERT_EQ(mesh->vertices.size(), 8u);
  const TriangleMesh::Vertex expected = {8, 2, 10};  // of (1, 1, 0)
  for (size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mesh->vertices[2][axis], expected[axis], 1e-12);
  }
  EXPECT_EQ(mesh->triangles[0], (TriangleMesh::Triangle{0, 1, 2}));
  EXPECT_EQ(mesh->triangles[2], (TriangleMesh::Triangle{4, 6, 5}));
}

TEST(GltfReader, TurnsMirroredStripsAndFans) {
  for (const int mode : {5, 6}) {
    Scene scene = SceneOf(Square());
    scene.primitive().erase("indices");
    scene.primitive()["mode"] = mode;
    const auto plain = ParseMesh(ToGlb(scene), "a.glb");
    scene.json["nodes"][0]["scale"] = {1, 1, -1};
    const auto turned = ParseMesh(ToGlb(scene), "a.glb");
    ASSERT_TRUE(plain.ok() && turned.ok()) << turned.status();
    ASSERT_EQ(turned->triangles.size(), 2u);
    std::multiset<std::array<uint32_t, 3>> expected, found;
    const auto begin_with_least = [](TriangleMesh::Triangle t) {
      std::rotate(t.begin(), std::ranges::min_element(t), t.end());
      return t;
    };
    for (const auto& [a, b, c] : plain->triangles) expected.insert(begin_with_least({a, c, b}));
    for (const auto& t : turned->triangles) found.insert(begin_with_least(t));
    EXPECT_EQ(found, expected) << mode;
  }
}

TEST(GltfReader, ReadsTheDefaultSceneElseTheRoots) {
  Scene scene = SceneOf(Square());
  scene.json["nodes"] = {{{"mesh", 0}, {"translation", {5, 0, 0}}},
                         {{"children", List(0)}},
                         {{"mesh", 0}, {"translation", {7, 0, 0}}}};
  const auto first_x = [&] {
    const auto mesh = ParseMesh(ToGlb(scene), "a.glb");
    return std::pair(mesh->vertices.size(), mesh->vertices[0][0]);
  };
  EXPECT_EQ(first_x(), std::pair(size_t{8}, 5.0));
  scene.json["scenes"] = List(Json{{"nodes", List(1)}}, Json{{"nodes", List(2)}});
  EXPECT_EQ(first_x(), std::pair(size_t{4}, 5.0));
  scene.json["scene"] = 1;
  EXPECT_EQ(first_x(), std::pair(size_t{4}, 7.0));
}

TEST(GltfReader, SharesThePointsOfPrimitives) {
  Scene scene = SceneOf(Square());
  scene.json["meshes"][0]["primitives"].push_back(scene.primitive());
  scene.json["meshes"][0]["primitives"].push_back({{"mode", 1}});
  const auto mesh = ParseMesh(ToGlb(scene), "a.glb");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices.size(), 4u);
  EXPECT_EQ(mesh->triangles.size(), 4u);
}

class GltfFilesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    scene_ = SceneOf(GltfBox());
    for (const char* name : {"outside.bin", "inside/a b.bin", "inside/parts/c.bin"}) {
      folder_.Write(name, scene_.binary);
    }
  }

  absl::StatusOr<TriangleMesh> ReadWith(const std::string& uri) {
    scene_.json["buffers"] = List(Json{{"byteLength", scene_.binary.size()}, {"uri", uri}});
    return ReadMeshFile(folder_.Write("inside/a.gltf", scene_.json.dump()));
  }

  const test::TemporaryFolder folder_;
  Scene scene_;
};

TEST_F(GltfFilesTest, ReadsBuffersBesideTheFile) {
  for (const char* uri : {"a%20b.bin", "parts/c.bin", "./parts/../a b.bin"}) {
    const auto mesh = ReadWith(uri);
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(*mesh, GltfBox());
  }
}

TEST_F(GltfFilesTest, ReadsNoOtherFiles) {
  std::error_code ignored;
  std::filesystem::create_symlink("../outside.bin", folder_ / "inside/link.bin", ignored);
  for (const std::string& uri : {std::string("../outside.bin"), std::string("%2e%2e/outside.bin"),
                                 folder_ / "outside.bin", std::string("link.bin")}) {
    const auto mesh = ReadWith(uri);
    EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << uri;
    EXPECT_THAT(std::string(mesh.status().message()), HasSubstr("only files in the folder"));
  }
  for (const char* uri : {"https://example.com/a.bin", "file:///a.bin"}) {
    EXPECT_THAT(std::string(ReadWith(uri).status().message()), HasSubstr("URLs are not read"));
  }
  EXPECT_EQ(ReadWith("none.bin").status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(ReadWith("parts").status().code(), absl::StatusCode::kNotFound);
}

TEST_F(GltfFilesTest, ReadsNoFilesForBytesInMemory) {
  scene_.json["buffers"] = List(Json{{"byteLength", 4}, {"uri", "a b.bin"}});
  EXPECT_THAT(std::string(ParseMesh(scene_.json.dump(), "a.gltf").status().message()),
              HasSubstr("for files alone"));
}

}  // namespace
}  // namespace bccskel
