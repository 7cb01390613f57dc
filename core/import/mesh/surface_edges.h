#ifndef BCCSKEL_CORE_IMPORT_MESH_SURFACE_EDGES_H_
#define BCCSKEL_CORE_IMPORT_MESH_SURFACE_EDGES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// One side of a triangle: from corner `side` to the next one.
struct TriangleSide {
  uint64_t edge = 0;  // smaller vertex in the high half, larger in the low half
  uint32_t triangle = 0;
  uint8_t side = 0;
  bool ascending = false;  // runs from the smaller vertex to the larger

  uint32_t smaller_vertex() const { return static_cast<uint32_t>(edge >> 32); }
  uint32_t larger_vertex() const { return static_cast<uint32_t>(edge); }
  // Corner of the triangle (0..2) at the smaller and at the larger vertex.
  int smaller_corner() const { return ascending ? side : (side + 1) % 3; }
  int larger_corner() const { return ascending ? (side + 1) % 3 : side; }
};

// The three sides of every triangle, sorted by edge.
// Needs: no triangle names a vertex twice.
std::vector<TriangleSide> SortedSides(std::span<const TriangleMesh::Triangle> triangles);

// Calls visit(std::span<const TriangleSide>) for every edge with all sides that lie on it.
template <typename Visit>
void ForEachEdge(std::span<const TriangleSide> sides, Visit visit) {
  for (size_t begin = 0; begin < sides.size();) {
    size_t end = begin + 1;
    while (end < sides.size() && sides[end].edge == sides[begin].edge) ++end;
    visit(sides.subspan(begin, end - begin));
    begin = end;
  }
}

struct EdgeCounts {
  uint64_t edges = 0;
  uint64_t boundary = 0;      // in exactly one triangle
  uint64_t non_manifold = 0;  // in more than two triangles
  uint64_t odd = 0;           // in an odd number of triangles
  uint64_t unbalanced = 0;    // passed more often in one sense than in the other
};
EdgeCounts CountEdges(std::span<const TriangleSide> sides);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_SURFACE_EDGES_H_
