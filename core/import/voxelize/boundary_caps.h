#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_BOUNDARY_CAPS_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_BOUNDARY_CAPS_H_

#include <cstdint>
#include <vector>

#include "core/import/mesh/mesh_report.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// Triangles that close an open surface: every connected piece of its boundary gets a fan around the
// mean of its vertices. Surface and caps together are passed equally often in both senses along
// every edge, so winding numbers along rays are integers.
struct BoundaryCaps {
  struct Cap {
    size_t begin = 0;  // its triangles in `triangles`
    size_t end = 0;
  };
  std::vector<TriangleMesh::Vertex> apexes;       // vertex surface.vertices.size() + n is apexes[n]
  std::vector<TriangleMesh::Triangle> triangles;  // the last corner is the apex
  std::vector<Cap> caps;
};
BoundaryCaps CapBoundary(const Surface& surface);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_BOUNDARY_CAPS_H_
