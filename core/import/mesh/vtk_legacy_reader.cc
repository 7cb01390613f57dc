// Legacy files of VTK with DATASET POLYDATA: POINTS, POLYGONS and TRIANGLE_STRIPS. Cells come as
// VTK wrote them before version 5.1 of the format (each a count and its corners) and since (OFFSETS
// and CONNECTIVITY). Vertices, lines and field data are stepped over; reading ends where the data
// of points or cells begin.

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/cell_collector.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/text_scanner.h"
#include "core/import/mesh/vtk_legacy_text.h"

namespace bccskel {
namespace {

constexpr std::string_view kVtkMark = "# vtk DataFile Version";

class VtkLegacyReader {
 public:
  VtkLegacyReader(std::string_view bytes, const MeshLimits& limits) : text_(bytes), mesh_(limits) {}

  absl::StatusOr<TriangleMesh> Read() && {
    BCCSKEL_RETURN_IF_ERROR(ReadHeader());
    for (std::string_view word = text_.Word(); !IsEnd(word); word = text_.Word()) {
      BCCSKEL_RETURN_IF_ERROR(ReadSection(word));
    }
    if (mesh_.triangle_count() == 0)
      return NoPolygonsError("VTK file", mesh_.vertex_count(), lines_);
    return std::move(mesh_).Finish();
  }

 private:
  static bool IsEnd(std::string_view word) {
    return word.empty() || EqualsIgnoringCase(word, "POINT_DATA") ||
           EqualsIgnoringCase(word, "CELL_DATA");
  }

  absl::Status ReadHeader() {
    std::string_view version = text_.Line();
    version.remove_prefix(std::min(kVtkMark.size(), version.size()));
    major_version_ = ParseDouble(VtkLegacyText(version).Word()).value_or(0);
    text_.Line();  // the title
    const std::string_view encoding = text_.Word();
    if (EqualsIgnoringCase(encoding, "BINARY")) {
      text_.SetNumbers(VtkLegacyText::Numbers::kBigEndian);
    } else if (!EqualsIgnoringCase(encoding, "ASCII")) {
      return text_.Error("ASCII or BINARY", encoding);
    }
    return ReadFieldsThenDataset();
  }

  absl::Status ReadFieldsThenDataset() {
    std::string_view word = text_.Word();
    for (; EqualsIgnoringCase(word, "FIELD"); word = text_.Word()) {
      BCCSKEL_RETURN_IF_ERROR(SkipFields());
    }
    if (!EqualsIgnoringCase(word, "DATASET")) return text_.Error("DATASET", word);
    const std::string_view dataset = text_.Word();
    if (EqualsIgnoringCase(dataset, "POLYDATA")) return absl::OkStatus();
    return text_.Error(
        "DATASET POLYDATA, the only VTK data that are a mesh (in ParaView, Extract Surface makes "
        "polygons of cells; images are read from NIfTI, NRRD, MetaImage and TIFF files)",
        dataset);
  }

  absl::Status ReadSection(std::string_view keyword) {
    const auto is = [&](std::string_view name) { return EqualsIgnoringCase(keyword, name); };
    if (is("POINTS")) return ReadPoints();
    if (is("POLYGONS")) return ReadCells(FaceShape::kPolygon);
    if (is("TRIANGLE_STRIPS")) return ReadCells(FaceShape::kStrip);
    if (is("VERTICES") || is("LINES")) return ReadCells(std::nullopt);
    if (is("FIELD")) return SkipFields();
    if (is("METADATA")) return SkipMetadata();
    return text_.Error("POINTS, POLYGONS, TRIANGLE_STRIPS, LINES, VERTICES, FIELD or METADATA",
                       keyword);
  }

  absl::Status ReadPoints() {
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, text_.Count(text_.Word()));
    if (count > kMostCounted) return text_.Error("fewer points", std::to_string(count));
    const std::string_view type = text_.Word();
    BCCSKEL_ASSIGN_OR_RETURN(const DataArray values, text_.Values(3 * count, type));
    return cells_.AddPoints(values);
  }

  // Without a shape, cells are only stepped over.
  absl::Status ReadCells(std::optional<FaceShape> shape) {
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, text_.Count(text_.Word()));
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t size, text_.Count(text_.Word()));
    const bool with_offsets = major_version_ >= 5;
    if (!shape) lines_ += with_offsets && count > 0 ? count - 1 : count;
    if (with_offsets) return ReadOffsetCells(shape, count, size);
    BCCSKEL_ASSIGN_OR_RETURN(const DataArray numbers, text_.Values(size, "int"));
    return shape ? AddCountedCells(*shape, count, numbers) : absl::OkStatus();
  }

  absl::Status ReadOffsetCells(std::optional<FaceShape> shape, uint64_t offsets, uint64_t corners) {
    BCCSKEL_ASSIGN_OR_RETURN(const DataArray ends, ReadNamed("OFFSETS", offsets));
    if (offsets == 0) return absl::OkStatus();
    BCCSKEL_ASSIGN_OR_RETURN(const DataArray named, ReadNamed("CONNECTIVITY", corners));
    // The first offset is 0: a cell without corners, which adds nothing.
    return shape ? cells_.AddCells(*shape, ends, named) : absl::OkStatus();
  }

  absl::StatusOr<DataArray> ReadNamed(std::string_view name, uint64_t count) {
    const std::string_view word = text_.Word();
    if (!EqualsIgnoringCase(word, name)) return text_.Error(name, word);
    return text_.Values(count, text_.Word());
  }

  absl::Status AddCountedCells(FaceShape shape, uint64_t count, const DataArray& numbers) {
    size_t at = 0;
    for (uint64_t n = 0; n < count; ++n) {
      const double left = static_cast<double>(numbers.size()) - static_cast<double>(at) - 1;
      const double corners = left < 0 ? 0 : numbers[at];
      if (!(corners >= 0 && corners <= left)) {
        return absl::InvalidArgumentError(
            absl::StrFormat("VTK cell %d of %d has %g corners; %g of %d numbers follow", n, count,
                            corners, std::max(left, 0.0), numbers.size()));
      }
      const size_t end = at + 1 + static_cast<size_t>(corners);
      BCCSKEL_RETURN_IF_ERROR(cells_.AddCell(shape, numbers, at + 1, end));
      at = end;
    }
    return absl::OkStatus();
  }

  // FIELD name arrays, each: name components tuples type, then the values.
  absl::Status SkipFields() {
    text_.Word();
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t arrays, text_.Count(text_.Word()));
    for (uint64_t n = 0; n < arrays; ++n) {
      std::string_view name = text_.Word();
      if (EqualsIgnoringCase(name, "METADATA")) {
        BCCSKEL_RETURN_IF_ERROR(SkipMetadata());
        name = text_.Word();
      }
      BCCSKEL_ASSIGN_OR_RETURN(const uint64_t components, text_.Count(text_.Word()));
      BCCSKEL_ASSIGN_OR_RETURN(const uint64_t tuples, text_.Count(text_.Word()));
      if (components > kMostCounted || tuples > kMostCounted) {
        return text_.Error("fewer values in FIELD", std::to_string(std::max(components, tuples)));
      }
      BCCSKEL_RETURN_IF_ERROR(text_.Values(components * tuples, text_.Word()).status());
    }
    return absl::OkStatus();
  }

  // Up to an empty line.
  absl::Status SkipMetadata() {
    text_.Line();
    while (!text_.AtEnd() && !text_.Line().empty()) continue;
    return absl::OkStatus();
  }

  static constexpr uint64_t kMostCounted = uint64_t{1} << 31;  // products fit 64 bits

  VtkLegacyText text_;
  MeshAssembler mesh_;
  CellCollector cells_{"VTK", mesh_};
  double major_version_ = 0;
  uint64_t lines_ = 0;  // and vertices
};

}  // namespace

absl::Status NoPolygonsError(std::string_view what, uint64_t points, uint64_t lines) {
  return absl::InvalidArgumentError(
      absl::StrFormat("%s has no polygons or triangle strips (%d points, %d lines and vertices). A "
                      "mesh has a closed surface; skeletons that bccskel writes are lines, so give "
                      "the file that the skeleton was made from",
                      what, points, lines));
}

bool IsVtkLegacy(std::string_view bytes) {
  return EqualsIgnoringCase(bytes.substr(0, kVtkMark.size()), kVtkMark);
}

absl::StatusOr<TriangleMesh> ParseVtkLegacy(std::string_view bytes, const MeshLimits& limits) {
  return VtkLegacyReader(bytes, limits).Read();
}

}  // namespace bccskel
