#include "core/import/mesh/mesh_assembler.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {

absl::Status MeshAssembler::AddVertex(TriangleMesh::Vertex vertex) {
  if (!std::ranges::all_of(vertex, [](double c) { return std::isfinite(c); })) {
    return absl::InvalidArgumentError(
        absl::StrFormat("vertex %d (counted from 0) is (%g, %g, %g): coordinates must be finite",
                        vertex_count(), vertex[0], vertex[1], vertex[2]));
  }
  if (vertex_count() >= limits_.max_vertices) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("more vertices than the limit of %d", limits_.max_vertices));
  }
  mesh_.vertices.push_back(vertex);
  return absl::OkStatus();
}

absl::Status MeshAssembler::AddPolygon(std::span<const int64_t> corners) {
  for (int64_t corner : corners) {
    if (corner < 0 || corner >= std::numeric_limits<uint32_t>::max()) {
      return absl::InvalidArgumentError(
          absl::StrFormat("vertex index %d (counted from 0) is outside 0 to 4294967294", corner));
    }
  }
  for (size_t n = 2; n < corners.size(); ++n) {
    if (triangle_count() >= limits_.max_triangles) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("more triangles than the limit of %d", limits_.max_triangles));
    }
    mesh_.triangles.push_back({static_cast<uint32_t>(corners[0]),
                               static_cast<uint32_t>(corners[n - 1]),
                               static_cast<uint32_t>(corners[n])});
  }
  return absl::OkStatus();
}

absl::Status MeshAssembler::AddStrip(std::span<const int64_t> corners) {
  for (size_t n = 2; n < corners.size(); ++n) {
    const int64_t a = corners[n - 2], b = corners[n - 1], c = corners[n];
    if (a == b || b == c || a == c) continue;
    const bool turned = n % 2 == 1;
    const std::array<int64_t, 3> triangle = {turned ? b : a, turned ? a : b, c};
    BCCSKEL_RETURN_IF_ERROR(AddPolygon(triangle));
  }
  return absl::OkStatus();
}

absl::StatusOr<TriangleMesh> MeshAssembler::Finish() && {
  if (mesh_.triangles.empty()) {
    const size_t points = mesh_.vertices.size();
    return absl::InvalidArgumentError(absl::StrFormat(
        "no triangles (%d %s)%s", points, points == 1 ? "vertex" : "vertices",
        points == 0 ? "" : ": points alone enclose nothing; make a surface of them first"));
  }
  for (size_t n = 0; n < mesh_.triangles.size(); ++n) {
    const uint32_t largest = std::ranges::max(mesh_.triangles[n]);
    if (largest >= mesh_.vertices.size()) {
      return absl::InvalidArgumentError(
          absl::StrFormat("triangle %d names vertex %d (counted from 0) of %d vertices", n, largest,
                          mesh_.vertices.size()));
    }
  }
  return std::move(mesh_);
}

absl::Status AddVertex(std::string_view format, TextScanner& text, MeshAssembler& mesh) {
  TriangleMesh::Vertex vertex;
  for (double& coordinate : vertex) {
    const std::string_view token = text.Token();
    const std::optional<double> value = ParseDouble(token);
    if (!value) return LineError(format, text, "expected a coordinate", token);
    coordinate = *value;
  }
  return mesh.AddVertex(vertex);
}

}  // namespace bccskel
