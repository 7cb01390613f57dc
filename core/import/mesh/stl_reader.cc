// STL, text and binary. Normals are dropped: they are often wrong, and the order of the corners
// says the same. Corners are stored unshared, as in the file; core/import/mesh/weld.h joins them.

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

constexpr size_t kHeaderBytes = 84;
constexpr size_t kTriangleBytes = 50;
constexpr size_t kNormalBytes = 12;

uint32_t LittleEndian32(const char* bytes) {
  uint32_t value = 0;
  for (int n = 3; n >= 0; --n) value = value << 8 | static_cast<uint8_t>(bytes[n]);
  return value;
}

uint64_t DeclaredTriangles(std::string_view bytes) {
  return bytes.size() < kHeaderBytes ? 0 : LittleEndian32(bytes.data() + kHeaderBytes - 4);
}

absl::Status AddTriangle(MeshAssembler& mesh, const std::array<TriangleMesh::Vertex, 3>& corners) {
  const int64_t first = static_cast<int64_t>(mesh.vertex_count());
  for (const TriangleMesh::Vertex& corner : corners) {
    BCCSKEL_RETURN_IF_ERROR(mesh.AddVertex(corner));
  }
  return mesh.AddPolygon(std::array<int64_t, 3>{first, first + 1, first + 2});
}

absl::StatusOr<TriangleMesh::Vertex> ParseVertex(TextScanner& text) {
  const std::string_view keyword = text.TokenAcrossLines();
  if (!EqualsIgnoringCase(keyword, "vertex"))
    return LineError("STL", text, "expected 'vertex'", keyword);
  TriangleMesh::Vertex vertex;
  for (double& coordinate : vertex) {
    const std::string_view token = text.TokenAcrossLines();
    const std::optional<double> value = ParseDouble(token);
    if (!value) return LineError("STL", text, "expected a coordinate", token);
    coordinate = *value;
  }
  return vertex;
}

// From behind "outer" to "endloop".
absl::Status ParseLoop(TextScanner& text, MeshAssembler& mesh) {
  const std::string_view loop = text.TokenAcrossLines();
  if (!EqualsIgnoringCase(loop, "loop")) return LineError("STL", text, "expected 'loop'", loop);
  std::array<TriangleMesh::Vertex, 3> corners;
  for (TriangleMesh::Vertex& corner : corners) {
    BCCSKEL_ASSIGN_OR_RETURN(corner, ParseVertex(text));
  }
  const std::string_view end = text.TokenAcrossLines();
  if (!EqualsIgnoringCase(end, "endloop")) return LineError("STL", text, "expected 'endloop'", end);
  return AddTriangle(mesh, corners);
}

}  // namespace

absl::StatusOr<TriangleMesh> ParseAsciiStl(std::string_view bytes, const MeshLimits& limits) {
  TextScanner text(bytes, TextScanner::Comments::kNone, LineContinuation::kNone);
  MeshAssembler mesh(limits);
  bool ended = false;
  while (text.NextLine()) {
    const std::string_view keyword = text.Token();
    ended = EqualsIgnoringCase(keyword, "endsolid");
    if (ended || EqualsIgnoringCase(keyword, "solid") || EqualsIgnoringCase(keyword, "facet")) {
      text.SkipLine();  // a name or a normal
    } else if (EqualsIgnoringCase(keyword, "outer")) {
      BCCSKEL_RETURN_IF_ERROR(ParseLoop(text, mesh));
    } else if (!EqualsIgnoringCase(keyword, "endfacet")) {
      return LineError("STL", text, "expected a keyword of STL", keyword);
    }
  }
  if (!ended) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "STL text ends after %d triangles without 'endsolid': cut?", mesh.triangle_count()));
  }
  return std::move(mesh).Finish();
}

bool IsBinaryStlOf(std::string_view front, uint64_t file_bytes) {
  return front.size() >= kHeaderBytes &&
         file_bytes == kHeaderBytes + kTriangleBytes * DeclaredTriangles(front);
}

bool HasBinaryStlLength(std::string_view bytes) { return IsBinaryStlOf(bytes, bytes.size()); }

absl::StatusOr<TriangleMesh> ParseBinaryStl(std::string_view bytes, const MeshLimits& limits) {
  if (bytes.size() < kHeaderBytes) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "binary STL of %d bytes is shorter than its header of 84 bytes", bytes.size()));
  }
  const uint64_t declared = DeclaredTriangles(bytes);
  const uint64_t held = (bytes.size() - kHeaderBytes) / kTriangleBytes;
  if (declared > held) {
    return absl::InvalidArgumentError(
        absl::StrFormat("binary STL declares %d triangles (%d bytes) but holds %d (%d bytes)",
                        declared, kHeaderBytes + declared * kTriangleBytes, held, bytes.size()));
  }
  MeshAssembler mesh(limits);
  for (uint64_t n = 0; n < declared; ++n) {
    const char* at = bytes.data() + kHeaderBytes + n * kTriangleBytes + kNormalBytes;
    std::array<TriangleMesh::Vertex, 3> corners;
    for (TriangleMesh::Vertex& corner : corners) {
      for (double& coordinate : corner) {
        coordinate = std::bit_cast<float>(LittleEndian32(at));
        at += 4;
      }
    }
    BCCSKEL_RETURN_IF_ERROR(AddTriangle(mesh, corners));
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
