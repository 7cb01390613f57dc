#ifndef BCCSKEL_CORE_IMPORT_MESH_MESH_FILE_H_
#define BCCSKEL_CORE_IMPORT_MESH_MESH_FILE_H_

#include <string>
#include <string_view>

#include "absl/status/statusor.h"
#include "core/import/mesh/mesh_limits.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// True when the name ends like a mesh file: .obj, .stl, .ply, .off, .glb, .gltf, .vtk, .vtp or
// .gii, each also with .gz; and for a file that begins like a surface of FreeSurfer, whose names
// have no ending of their own.
bool IsMeshPath(const std::string& path);
// Whether a file of any name, not compressed, begins like one of these formats. OBJ and glTF, which
// begin like many other texts, are known by their names.
bool BeginsLikeMesh(const std::string& path);

// True when the name ends like a glTF file, whose y axis points up.
bool IsGltfPath(const std::string& path);

// Reads OBJ, STL (text, binary), PLY (text, both byte orders), OFF (also COFF and the like), glTF
// 2.0 (.glb, .gltf and its buffers beside it), polygon data of VTK (legacy and XML) or surfaces of
// GIFTI and FreeSurfer, each also compressed by gzip. The content decides the format; the name
// helps only where the content says nothing. Polygons become fans of triangles; normals, colors and
// textures are dropped. Units:   coordinates as in the file, in double. Those of glTF are moved by
// its nodes, and y stays
//          up; GIFTI's CoordinateSystemTransformMatrix is not applied; those of FreeSurfer are
//          surface RAS, in mm.
// Errors:  NOT_FOUND, PERMISSION_DENIED; INVALID_ARGUMENT (malformed, cut, coordinates that are not
//          finite, bad indices, no triangles, a format that is not supported); RESOURCE_EXHAUSTED.
absl::StatusOr<TriangleMesh> ReadMeshFile(const std::string& path, const MeshLimits& limits = {});

// The same for bytes in memory (not compressed); `name` is used for its ending and in messages. No
// other files are read.
absl::StatusOr<TriangleMesh> ParseMesh(std::string_view bytes, std::string_view name,
                                       const MeshLimits& limits = {});

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_MESH_FILE_H_
