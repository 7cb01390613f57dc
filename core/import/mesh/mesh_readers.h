#ifndef BCCSKEL_CORE_IMPORT_MESH_MESH_READERS_H_
#define BCCSKEL_CORE_IMPORT_MESH_MESH_READERS_H_

// The readers of the formats; mesh_file.h chooses between them.
//
// Why they are written here: of the libraries in Debian 12, OpenMesh 9.0 keeps coordinates in float
// in all four formats (0.1 comes back as 0.10000000149, 1000000000.12 as 1000000000), accepts a cut
// OFF file and loses faces behind an OBJ line continuation; assimp keeps floats; tinyobjloader 2.0
// refuses the line continuation, accepts NaN and reads an index beyond 64 bits as a small one;
// CGAL's readers come under the (L)GPL; VTK's libraries take 100 MB. So these are small, share one
// scanner and one assembler, and read numbers with std::from_chars, which rounds correctly.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/mesh/mesh_limits.h"
#include "core/import/mesh/triangle_mesh.h"

namespace bccskel {

// Shapes: `bytes` is the whole file, expanded.
// Cost:   linear in the bytes; memory in proportion to the contents, whatever the file declares.
// Errors: INVALID_ARGUMENT (names the line, the value, the shortfall), RESOURCE_EXHAUSTED.
absl::StatusOr<TriangleMesh> ParseOff(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseObj(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParsePly(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseAsciiStl(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseBinaryStl(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseVtkLegacy(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseVtp(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseGifti(std::string_view bytes, const MeshLimits& limits);
absl::StatusOr<TriangleMesh> ParseFreeSurfer(std::string_view bytes, const MeshLimits& limits);
// glTF, as text or as .glb. Buffers may be files in `folder` and below; without one, none are read.
absl::StatusOr<TriangleMesh> ParseGltf(std::string_view bytes, std::optional<std::string> folder,
                                       const MeshLimits& limits);

// Is the length exactly that of a binary STL with the count it declares?
bool HasBinaryStlLength(std::string_view bytes);
// The same for a file of which these are the first bytes.
bool IsBinaryStlOf(std::string_view front, uint64_t file_bytes);
// Is this the keyword of an OFF file, such as OFF, COFF or STCNOFF?
bool IsOffKeyword(std::string_view token);
// Does the file begin like a legacy file of VTK?
bool IsVtkLegacy(std::string_view bytes);
// Does the file begin like one of FreeSurfer's, of which only triangles are read?
bool IsFreeSurfer(std::string_view bytes);

// INVALID_ARGUMENT: `what` has points and lines only, as a skeleton of ours.
absl::Status NoPolygonsError(std::string_view what, uint64_t points, uint64_t lines);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_MESH_MESH_READERS_H_
