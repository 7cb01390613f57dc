// OFF and its relatives with normals, colors and texture coordinates: one vertex or face per line,
// what follows the three coordinates or the corners is dropped.

#include <cstdint>
#include <optional>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/text_scanner.h"

namespace bccskel {
namespace {

struct OffCounts {
  uint64_t vertices = 0;
  uint64_t faces = 0;
};

absl::StatusOr<uint64_t> ParseCount(const TextScanner& text, std::string_view token) {
  const std::optional<int64_t> count = ParseInteger(token);
  if (!count || *count < 0) return LineError("OFF", text, "expected a count of 0 or more", token);
  return static_cast<uint64_t>(*count);
}

absl::StatusOr<OffCounts> ParseCounts(TextScanner& text, std::string_view first) {
  OffCounts counts;
  BCCSKEL_ASSIGN_OR_RETURN(counts.vertices, ParseCount(text, first));
  BCCSKEL_ASSIGN_OR_RETURN(counts.faces, ParseCount(text, text.TokenAcrossLines()));
  text.SkipLine();  // the number of edges, often 0 or missing
  return counts;
}

// The keyword is optional, the counts may stand on its line.
absl::StatusOr<OffCounts> ParseHeader(TextScanner& text) {
  std::string_view token = text.TokenAcrossLines();
  if (IsOffKeyword(token)) {
    if (token.find('4') != token.npos || token.find('n') != token.npos) {
      return LineError("OFF", text, "only three dimensions are read", token);
    }
    token = text.TokenAcrossLines();
    if (EqualsIgnoringCase(token, "BINARY")) {
      return LineError("OFF", text, "only text is read, not binary OFF", token);
    }
  }
  return ParseCounts(text, token);
}

// A vertex line has at least 6 bytes, a face line at least 2.
absl::Status CheckCounts(const OffCounts& counts, size_t bytes) {
  if (counts.vertices <= bytes / 5 && counts.faces <= bytes / 2) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("OFF header declares %d vertices and %d faces, more than a file of %d bytes "
                      "can hold",
                      counts.vertices, counts.faces, bytes));
}

absl::Status ParseFace(TextScanner& text, uint64_t vertices, std::vector<int64_t>& corners,
                       MeshAssembler& mesh) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, ParseCount(text, text.Token()));
  corners.clear();
  for (uint64_t n = 0; n < count; ++n) {
    const std::string_view token = text.Token();
    const std::optional<int64_t> corner = ParseInteger(token);
    if (!corner || *corner < 0 || static_cast<uint64_t>(*corner) >= vertices) {
      return LineError("OFF", text, absl::StrFormat("expected a vertex index below %d", vertices),
                       token);
    }
    corners.push_back(*corner);
  }
  return mesh.AddPolygon(corners);
}

absl::Status ShortfallError(const char* what, uint64_t found, uint64_t declared) {
  return absl::InvalidArgumentError(
      absl::StrFormat("OFF file ends after %d of %d %s", found, declared, what));
}

}  // namespace

bool IsOffKeyword(std::string_view token) {
  for (std::string_view prefix : {"ST", "C", "N", "4", "n"}) {
    if (token.starts_with(prefix)) token.remove_prefix(prefix.size());
  }
  return token == "OFF";
}

absl::StatusOr<TriangleMesh> ParseOff(std::string_view bytes, const MeshLimits& limits) {
  TextScanner text(bytes, TextScanner::Comments::kHash, LineContinuation::kNone);
  BCCSKEL_ASSIGN_OR_RETURN(const OffCounts counts, ParseHeader(text));
  BCCSKEL_RETURN_IF_ERROR(CheckCounts(counts, bytes.size()));
  MeshAssembler mesh(limits);
  for (uint64_t n = 0; n < counts.vertices; ++n) {
    if (!text.NextLine()) return ShortfallError("vertices", n, counts.vertices);
    BCCSKEL_RETURN_IF_ERROR(AddVertex("OFF", text, mesh));
  }
  std::vector<int64_t> corners;
  for (uint64_t n = 0; n < counts.faces; ++n) {
    if (!text.NextLine()) return ShortfallError("faces", n, counts.faces);
    BCCSKEL_RETURN_IF_ERROR(ParseFace(text, counts.vertices, corners, mesh));
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
