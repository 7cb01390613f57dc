#ifndef BCCSKEL_CORE_IMPORT_MESH_MESH_LIMITS_H_
#define BCCSKEL_CORE_IMPORT_MESH_MESH_LIMITS_H_

#include <cstdint>

namespace bccskel {

// What a mesh file may cost. Declared counts are compared with the bytes that are there before
// anything is allocated for them, so these bound honest files and gzip bombs.
struct MeshLimits {
  uint64_t max_file_bytes = uint64_t{2} << 30;  // after expansion of gzip
  uint64_t max_vertices = uint64_t{1} << 28;
  uint64_t max_triangles = uint64_t{1} << 28;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_MESH_LIMITS_H_
