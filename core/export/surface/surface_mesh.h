#ifndef BCCSKEL_CORE_EXPORT_SURFACE_SURFACE_MESH_H_
#define BCCSKEL_CORE_EXPORT_SURFACE_SURFACE_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/volume/volume.h"

namespace bccskel {

using SurfaceVertex = std::array<float, 3>;  // lattice units
// Three positions in SurfaceMesh::vertices, counterclockwise seen from the background.
using SurfaceTriangle = std::array<uint32_t, 3>;

// What separates an object from the background.
struct SurfaceMesh {
  std::vector<SurfaceVertex> vertices;
  std::vector<SurfaceTriangle> triangles;
};

// The surface between an object and its background: marching tetrahedra over the tetrahedra of
// mutually adjacent lattice points, with a vertex in the middle of every step from an object point
// to a background neighbor. Always closed, oriented and without self-contact: each edge belongs to
// two triangles. It bounds a body that contracts to the object, so it has a component for each
// component and each cavity, and twice the object's Euler characteristic.
// Cost:   follows the border points, about 6 vertices and 11 triangles each.
// Errors: CANCELLED, DEADLINE_EXCEEDED; RESOURCE_EXHAUSTED for 2^32 vertices or more.
absl::StatusOr<SurfaceMesh> ExtractSurface(const Volume& object, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_SURFACE_SURFACE_MESH_H_
