#ifndef BCCSKEL_CORE_IMPORT_MESH_MESH_ASSEMBLER_H_
#define BCCSKEL_CORE_IMPORT_MESH_MESH_ASSEMBLER_H_

#include <cstdint>
#include <span>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/mesh/mesh_limits.h"
#include "core/import/mesh/text_scanner.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// Collects the elements that the readers find and runs the checks that all of them share.
class MeshAssembler {
 public:
  explicit MeshAssembler(const MeshLimits& limits) : limits_(limits) {}

  // Errors: INVALID_ARGUMENT for a coordinate that is not finite, RESOURCE_EXHAUSTED.
  absl::Status AddVertex(TriangleMesh::Vertex vertex);
  // Cuts the polygon into a fan around its first corner; fewer than three corners bound nothing and
  // are dropped. Corners may name vertices that come later in the file.
  // Errors: INVALID_ARGUMENT for an index no vertex can have, RESOURCE_EXHAUSTED.
  absl::Status AddPolygon(std::span<const int64_t> corners);
  // Adds a strip: each corner from the third on makes a triangle with the two before it, every
  // second one turned over. Triangles that name a corner twice only join pieces of a strip and are
  // dropped. Errors: those of AddPolygon().
  absl::Status AddStrip(std::span<const int64_t> corners);

  uint64_t vertex_count() const { return mesh_.vertices.size(); }
  uint64_t triangle_count() const { return mesh_.triangles.size(); }

  // Errors: INVALID_ARGUMENT when there is no triangle or one names a vertex that is not there.
  absl::StatusOr<TriangleMesh> Finish() &&;

 private:
  MeshLimits limits_;
  TriangleMesh mesh_;
};

// Adds the vertex that the next three tokens of the line of `text` are; `format` is for errors.
// Errors: those of MeshAssembler::AddVertex(); INVALID_ARGUMENT for a token that is no number.
absl::Status AddVertex(std::string_view format, TextScanner& text, MeshAssembler& mesh);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_MESH_ASSEMBLER_H_
