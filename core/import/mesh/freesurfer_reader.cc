// FreeSurfer's surfaces of triangles (lh.white, rh.pial, ...), big-endian: a mark of three bytes, a
// line of text and mostly an empty one, the numbers of vertices and triangles, coordinates as
// float32, corners as int32. What follows, as the volume that the surface was made from, is not
// read: coordinates stay surface RAS.
// https://surfer.nmr.mgh.harvard.edu/fswiki/FileFormats

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/scalar.h"

namespace bccskel {
namespace {

constexpr std::string_view kTriangles = "\xff\xff\xfe";
// Quadrangles, of old; the first mark is also that of values per vertex.
constexpr std::array<std::string_view, 2> kOthers = {"\xff\xff\xff", "\xff\xff\xfd"};

absl::StatusOr<std::string_view> BehindText(std::string_view bytes) {
  const size_t end = bytes.find('\n');
  if (end == bytes.npos) {
    return absl::InvalidArgumentError("FreeSurfer: the line of text behind the mark has no end");
  }
  bytes.remove_prefix(end + 1);
  if (bytes.starts_with('\n')) bytes.remove_prefix(1);
  return bytes;
}

double NumberAt(std::string_view bytes, size_t index, Scalar type) {
  return ScalarAt(bytes.data() + 4 * index, type, std::endian::big);
}

}  // namespace

bool IsFreeSurfer(std::string_view bytes) {
  const auto begins = [bytes](std::string_view mark) { return bytes.starts_with(mark); };
  return begins(kTriangles) || std::ranges::any_of(kOthers, begins);
}

absl::StatusOr<TriangleMesh> ParseFreeSurfer(std::string_view bytes, const MeshLimits& limits) {
  if (!bytes.starts_with(kTriangles)) {
    return absl::InvalidArgumentError(
        "FreeSurfer: values per vertex (as lh.thickness) or an old surface of quadrangles; only "
        "surfaces of triangles (as lh.white) are read; `mris_convert` writes quadrangles as such");
  }
  BCCSKEL_ASSIGN_OR_RETURN(bytes, BehindText(bytes.substr(kTriangles.size())));
  if (bytes.size() < 8) {
    return absl::InvalidArgumentError("FreeSurfer: the file ends before the number of triangles");
  }
  const double points = NumberAt(bytes, 0, Scalar::kInt32);
  const double triangles = NumberAt(bytes, 1, Scalar::kInt32);
  bytes.remove_prefix(8);
  const double held = static_cast<double>(bytes.size());
  if (points < 0 || triangles < 0 || 12 * (points + triangles) > held) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "FreeSurfer: %.0f vertices and %.0f triangles are declared, of 12 bytes each; %d bytes "
        "follow",
        points, triangles, bytes.size()));
  }
  const auto vertices = static_cast<size_t>(points);
  const size_t all = vertices + static_cast<size_t>(triangles);
  MeshAssembler mesh(limits);
  for (size_t n = 0; n < all; ++n) {
    const auto at = [&](size_t axis, Scalar type) { return NumberAt(bytes, 3 * n + axis, type); };
    if (n < vertices) {
      constexpr Scalar kFloat = Scalar::kFloat32;
      BCCSKEL_RETURN_IF_ERROR(mesh.AddVertex({at(0, kFloat), at(1, kFloat), at(2, kFloat)}));
    } else {
      std::array<int64_t, 3> corners;
      for (size_t k = 0; k < 3; ++k) corners[k] = static_cast<int64_t>(at(k, Scalar::kInt32));
      BCCSKEL_RETURN_IF_ERROR(mesh.AddPolygon(corners));
    }
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
