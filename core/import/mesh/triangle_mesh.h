#ifndef BCCSKEL_CORE_IMPORT_MESH_TRIANGLE_MESH_H_
#define BCCSKEL_CORE_IMPORT_MESH_TRIANGLE_MESH_H_

#include <array>
#include <cstdint>
#include <vector>

namespace bccskel {

// A surface as indexed triangles. Coordinates are world coordinates in the file's unit and stay
// double up to the grid; indices count from 0.
struct TriangleMesh {
  using Vertex = std::array<double, 3>;
  using Triangle = std::array<uint32_t, 3>;

  std::vector<Vertex> vertices;
  std::vector<Triangle> triangles;

  friend bool operator==(const TriangleMesh&, const TriangleMesh&) = default;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_TRIANGLE_MESH_H_
