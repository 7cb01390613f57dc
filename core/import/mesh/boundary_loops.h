#ifndef BCCSKEL_CORE_IMPORT_MESH_BOUNDARY_LOOPS_H_
#define BCCSKEL_CORE_IMPORT_MESH_BOUNDARY_LOOPS_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/import/mesh/surface_edges.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// The boundary of an open surface as closed loops of vertices, passed against the surplus of the
// surface: surface and loops together pass every edge equally often in both senses. No loop passes
// a vertex twice.
// Shapes: `sides` of all triangles, sorted; vertices are below `vertices`.
std::vector<std::vector<uint32_t>> BoundaryLoops(std::span<const TriangleSide> sides,
                                                 size_t vertices);

// The vertex at which a polygon of so many vertices is split.
constexpr size_t MiddleOfCap(size_t vertices) { return (vertices - 1) / 2; }

// Splits the polygon of the vertices from position `begin` to `end` of a loop, closed by the chord
// from the last to the first: visits its triangle (begin, middle, end), then the polygons beside
// it in the same way. So all triangles but a few lie near their part of the loop.
template <typename Visit>
void ForEachTriangleOfCap(size_t begin, size_t end, Visit visit) {
  if (end - begin < 2) return;
  const size_t middle = begin + MiddleOfCap(end - begin + 1);
  visit(begin, middle, end);
  ForEachTriangleOfCap(begin, middle, visit);
  ForEachTriangleOfCap(middle, end, visit);
}

// The triangles that close the loops. Surface and caps have no boundary, so winding numbers along
// rays are integers.
std::vector<TriangleMesh::Triangle> CapsOf(const std::vector<std::vector<uint32_t>>& loops);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_BOUNDARY_LOOPS_H_
