// Any bytes as a mesh file: an error or a mesh whose indices hold, never a crash.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "core/import/mesh/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  // OBJ and STL as text have no mark of their own: there the name decides. Those of glTF, VTK and
  // GIFTI are in the seeds.
  for (const std::string_view name : {"fuzz.obj", "fuzz.stl"}) {
    const auto mesh = bccskel::ParseMesh(bytes, name);
    if (!mesh.ok()) continue;
    for (const auto& triangle : mesh->triangles) {
      for (const uint32_t corner : triangle) {
        if (corner >= mesh->vertices.size()) std::abort();
      }
    }
  }
  return 0;
}
