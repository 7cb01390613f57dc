#include "tests/core/import/mesh/gltf_scene.h"

#include <vector>

#include "absl/strings/escaping.h"
#include "tests/core/import/mesh/mesh_bytes.h"

namespace bccskel::testing {

Scene SceneOf(const TriangleMesh& mesh) {
  Scene scene;
  const size_t points =
      scene.AddAccessor(BytesOf(CoordinatesOf<float>(mesh)), kFloat, mesh.vertices.size(), "VEC3");
  const size_t corners = scene.AddAccessor(BytesOf(CornersOf<uint32_t>(mesh)), kUint32,
                                           3 * mesh.triangles.size(), "SCALAR");
  scene.AddPrimitive({{"attributes", {{"POSITION", points}}}, {"indices", corners}});
  return scene;
}

std::string ToGltf(Scene scene) {
  const std::string uri =
      "data:application/octet-stream;base64," + absl::Base64Escape(scene.binary);
  scene.json["buffers"] = List(Json{{"byteLength", scene.binary.size()}, {"uri", uri}});
  return scene.json.dump();
}

std::string ToGlb(Scene scene) {
  scene.json["buffers"] = List(Json{{"byteLength", scene.binary.size()}});
  std::string json = scene.json.dump();
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string binary = scene.binary;
  binary.resize((binary.size() + 3) / 4 * 4);
  const auto words = [](std::vector<uint32_t> numbers) { return BytesOf(numbers); };
  const auto size = [](const std::string& bytes) { return static_cast<uint32_t>(bytes.size()); };
  return "glTF" + words({2, 28 + size(json) + size(binary), size(json), 0x4E4F534A}) + json +
         words({size(binary), 0x004E4942}) + binary;
}

}  // namespace bccskel::testing
