#ifndef BCCSKEL_CORE_IMPORT_MESH_GLTF_TRANSFORM_H_
#define BCCSKEL_CORE_IMPORT_MESH_GLTF_TRANSFORM_H_

#include <array>

#include "absl/status/statusor.h"
#include "core/import/mesh/gltf_item.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// An affine map: columns for x, y, z, then the shift.
class GltfTransform {
 public:
  // Of a node: its matrix, or translation, rotation and scale; nothing moves without.
  // Errors: INVALID_ARGUMENT for lists of another length.
  static absl::StatusOr<GltfTransform> Of(const GltfItem& node);

  // First `inner`, then this.
  GltfTransform After(const GltfTransform& inner) const;
  TriangleMesh::Vertex Apply(const TriangleMesh::Vertex& place) const;
  // Whether it turns surfaces inside out.
  bool Mirrors() const;

 private:
  TriangleMesh::Vertex Turn(const TriangleMesh::Vertex& direction) const;

  std::array<TriangleMesh::Vertex, 4> columns_ = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}}};
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_GLTF_TRANSFORM_H_
