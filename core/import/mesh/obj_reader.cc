// Wavefront OBJ: `v` and `f` lines; everything else is dropped. A corner is v, v/vt, v//vn or
// v/vt/vn; v counts from 1, or backwards from the last vertex when negative.

#include <cstdint>
#include <optional>
#include <vector>

#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

absl::Status ParseFace(TextScanner& text, std::vector<int64_t>& corners, MeshAssembler& mesh) {
  corners.clear();
  for (std::string_view token = text.Token(); !token.empty(); token = text.Token()) {
    const std::optional<int64_t> index = ParseInteger(token.substr(0, token.find('/')));
    if (!index || *index == 0) {
      return LineError("OBJ", text, "expected a vertex index that is a 64-bit integer and not 0",
                       token);
    }
    const int64_t vertices = static_cast<int64_t>(mesh.vertex_count());
    if (*index < -vertices) return LineError("OBJ", text, "a vertex before the first one", token);
    corners.push_back(*index > 0 ? *index - 1 : vertices + *index);
  }
  return mesh.AddPolygon(corners);
}

}  // namespace

absl::StatusOr<TriangleMesh> ParseObj(std::string_view bytes, const MeshLimits& limits) {
  TextScanner text(bytes, TextScanner::Comments::kHash, LineContinuation::kBackslash);
  MeshAssembler mesh(limits);
  std::vector<int64_t> corners;
  while (text.NextLine()) {
    const std::string_view keyword = text.Token();
    if (keyword == "v") {
      BCCSKEL_RETURN_IF_ERROR(AddVertex("OBJ", text, mesh));
    } else if (keyword == "f") {
      BCCSKEL_RETURN_IF_ERROR(ParseFace(text, corners, mesh));
    }
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
