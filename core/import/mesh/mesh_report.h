#ifndef BCCSKEL_CORE_IMPORT_MESH_MESH_REPORT_H_
#define BCCSKEL_CORE_IMPORT_MESH_MESH_REPORT_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// How far a surface separates an inside from an outside.
enum class SurfaceClosure {
  kOpen,      // some edge is in an odd number of triangles
  kClosed,    // every edge is in an even number: parity along rays is defined
  kOriented,  // and passed equally often in both senses: winding numbers along rays are integers
};

// Triangles that hang together by edges.
struct SurfaceComponent {
  uint64_t triangles = 0;
  // Handles; set when every edge of the component is in exactly two triangles.
  std::optional<int64_t> genus;
  double volume = 0;  // signed, positive when the triangles turn outward; unit of length cubed
  std::array<double, 3> lower = {};  // bounding box
  std::array<double, 3> upper = {};
  int32_t depth = 0;        // how many other components enclose this one
  uint32_t root = 0;        // the outermost component that encloses this one, or itself
  int32_t orientation = 1;  // +1 when it turns like its root, -1 when opposite (a cavity's wall)
  int32_t winding_outside = 0;  // sum of the orientations of the components that enclose this one
};

// Components, loops and cavities of a solid.
struct SolidTopology {
  int64_t components = 0;
  int64_t loops = 0;
  int64_t cavities = 0;

  friend constexpr bool operator==(const SolidTopology&, const SolidTopology&) = default;
};

// What the triangles say before any grid is laid over them. Corners with equal coordinates count
// as one vertex where only that closes the surface; triangles that name a vertex twice are dropped,
// and so are those of no area where only that closes the surface.
struct MeshReport {
  uint64_t vertices = 0;             // that triangles use
  uint64_t triangles = 0;            // kept
  uint64_t dropped_triangles = 0;    // degenerate
  uint64_t two_sided_triangles = 0;  // of which the reverse was there, too, and was dropped
  uint64_t edges = 0;
  uint64_t boundary_edges = 0;      // in one triangle
  uint64_t non_manifold_edges = 0;  // in more than two triangles
  uint64_t misoriented_edges = 0;   // in two or more triangles, not equally often in both senses
  SurfaceClosure closure = SurfaceClosure::kOpen;
  // Area of the triangles that would close the holes, relative to that of the others; 0 if closed.
  double hole_share = 0;
  std::vector<SurfaceComponent> components;
  std::optional<int64_t> genus;      // of all components together
  double volume = 0;                 // sum over components; infinite where a double cannot hold it
  std::array<double, 3> lower = {};  // bounding box of the kept triangles
  std::array<double, 3> upper = {};
  // False when there are too many components to find out which encloses which; depths are 0 then.
  bool nesting_known = false;

  // Every edge in exactly two triangles.
  bool watertight() const { return boundary_edges == 0 && non_manifold_edges == 0; }
  bool consistently_oriented() const { return misoriented_edges == 0; }

  // The solid as read off the surface, for the two rules of filling; right where no two triangles
  // cross. Nothing when the surface is not watertight, a genus is unknown, or, for the rule of
  // winding, the orientation is inconsistent.
  std::optional<SolidTopology> SolidByParity() const;
  std::optional<SolidTopology> SolidByWinding() const;
};

MeshReport AnalyzeMesh(const TriangleMesh& mesh);

// A mesh ready to be filled, moved and scaled into the unit cube so that no size overflows.
struct Surface {
  std::vector<TriangleMesh::Vertex> vertices;  // 0..1 on the longest axis, the others shorter
  std::vector<TriangleMesh::Triangle> triangles;
  std::vector<uint32_t> component_of;                 // for each triangle
  std::vector<std::vector<uint32_t>> boundary_loops;  // of an open surface, see BoundaryLoops()
  std::array<double, 3> lower = {};                   // world position of (0, 0, 0)
  std::array<double, 3> upper_unit = {};              // far corner of the box in units
  double half_size = 0;    // half the world length of the unit; always finite
  double unit_volume = 0;  // sum of |volume|, walls of cavities negative, in cubes of the unit
  MeshReport report;
};
Surface PrepareSurface(const TriangleMesh& mesh);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_MESH_REPORT_H_
