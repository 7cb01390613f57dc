#ifndef BCCSKEL_TESTS_CORE_IMPORT_MESH_GLTF_SCENE_H_
#define BCCSKEL_TESTS_CORE_IMPORT_MESH_GLTF_SCENE_H_

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>

#include "core/import/mesh/triangle_mesh.h"
#include "tests/core/import/mesh/mesh_shapes.h"

namespace bccskel::testing {

using Json = nlohmann::json;

// Braces around one value would be that value.
template <typename... Values>
Json List(Values... values) {
  return Json::array({Json(std::move(values))...});
}

// Types of numbers.
constexpr int kByte = 5120, kUint8 = 5121, kInt16 = 5122, kUint16 = 5123, kUint32 = 5125,
              kFloat = 5126;

// A document and its only buffer.
struct Scene {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::string binary;

  size_t AddView(const std::string& bytes, Json more = Json::object()) {
    more["buffer"] = 0;
    more["byteOffset"] = binary.size();
    more["byteLength"] = bytes.size();
    json["bufferViews"].push_back(more);
    binary += bytes;
    return json["bufferViews"].size() - 1;
  }
  size_t AddAccessor(const std::string& bytes, int type, size_t count, const char* shape) {
    json["accessors"].push_back({{"bufferView", AddView(bytes)},
                                 {"componentType", type},
                                 {"count", count},
                                 {"type", shape}});
    return json["accessors"].size() - 1;
  }
  void AddPrimitive(Json primitive) {
    json["meshes"] = List(Json{{"primitives", List(std::move(primitive))}});
    json["nodes"] = List(Json{{"mesh", 0}});
  }
  Json& primitive() { return json["meshes"][0]["primitives"][0]; }
};

// What the tests draw.
inline TriangleMesh GltfBox() { return Box({-1, 0.5, 2}, {3, 4, 5}); }

// The mesh as floats and 32-bit indices, drawn by one node.
Scene SceneOf(const TriangleMesh& mesh);

// The file, with the buffer in base64 or as a chunk.
std::string ToGltf(Scene scene);
std::string ToGlb(Scene scene);

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_MESH_GLTF_SCENE_H_
