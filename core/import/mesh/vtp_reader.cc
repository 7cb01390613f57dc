// XML files of VTK with polygon data (.vtp): the points, polygons and strips of every piece. Data
// of points and cells, vertices and lines are not read.

#include <cstdint>
#include <string>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/cell_collector.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/vtp_array.h"
#include "core/import/mesh/xml_document.h"

namespace bccskel {
namespace {

struct VtpParts {
  std::string xml;  // with an empty <AppendedData>
  std::string_view appended;
};

// Appended data may be raw bytes, which no XML parser takes.
VtpParts SplitAppended(std::string_view bytes) {
  const size_t element = bytes.find("<AppendedData");
  if (element == bytes.npos) return {std::string(bytes), {}};
  const size_t end = std::min(bytes.find('>', element), bytes.size() - 1) + 1;
  const size_t mark = bytes.find_first_not_of(" \t\r\n", end);
  const bool marked = mark != bytes.npos && bytes[mark] == '_';
  return {std::string(bytes.substr(0, end)) + "</AppendedData></VTKFile>",
          marked ? bytes.substr(mark + 1) : std::string_view()};
}

absl::Status ReadVtpCells(const pugi::xml_node& cells, FaceShape shape, VtpArrayReader& arrays,
                          CellCollector& collector) {
  const pugi::xml_node ends = cells.find_child_by_attribute("DataArray", "Name", "offsets");
  const pugi::xml_node corners = cells.find_child_by_attribute("DataArray", "Name", "connectivity");
  if (!ends && !corners) return absl::OkStatus();
  if (!ends || !corners) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "VTP: <%s> must have the arrays 'connectivity' and 'offsets'", cells.name()));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const DataArray end_values, arrays.Read(ends));
  BCCSKEL_ASSIGN_OR_RETURN(const DataArray corner_values, arrays.Read(corners));
  return collector.AddCells(shape, end_values, corner_values);
}

absl::Status ReadVtpPoints(const pugi::xml_node& piece, VtpArrayReader& arrays,
                           CellCollector& collector) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, XmlCount("VTP", piece, "NumberOfPoints"));
  const pugi::xml_node array = piece.child("Points").child("DataArray");
  if (count == 0) return absl::OkStatus();
  if (!array)
    return absl::InvalidArgumentError("VTP: a <Piece> has no <Points> with a <DataArray>");
  BCCSKEL_ASSIGN_OR_RETURN(const DataArray values, arrays.Read(array));
  if (values.size() / 3 != count) {
    return absl::InvalidArgumentError(
        absl::StrFormat("VTP: NumberOfPoints is %d, but <Points> has %d values, not three for each",
                        count, values.size()));
  }
  return collector.AddPoints(values);
}

absl::Status ReadVtpPiece(const pugi::xml_node& piece, VtpArrayReader& arrays,
                          CellCollector& collector) {
  BCCSKEL_RETURN_IF_ERROR(ReadVtpPoints(piece, arrays, collector));
  BCCSKEL_RETURN_IF_ERROR(
      ReadVtpCells(piece.child("Polys"), FaceShape::kPolygon, arrays, collector));
  return ReadVtpCells(piece.child("Strips"), FaceShape::kStrip, arrays, collector);
}

absl::StatusOr<pugi::xml_node> PolyDataOf(const pugi::xml_node& file) {
  if (!file) return absl::InvalidArgumentError("VTP: there is no element <VTKFile>");
  const std::string_view type = XmlAttribute(file, "type");
  if (type == "PolyData") return file.child("PolyData");
  return absl::InvalidArgumentError(
      absl::StrFormat("VTP: the file holds VTK data of type '%s'; only PolyData is a mesh (in "
                      "ParaView, Extract Surface makes it)",
                      type.substr(0, 40)));
}

}  // namespace

absl::StatusOr<TriangleMesh> ParseVtp(std::string_view bytes, const MeshLimits& limits) {
  const VtpParts parts = SplitAppended(bytes);
  BCCSKEL_ASSIGN_OR_RETURN(const pugi::xml_document document, ParseXml("VTP", parts.xml));
  const pugi::xml_node file = document.child("VTKFile");
  BCCSKEL_ASSIGN_OR_RETURN(const pugi::xml_node polygons, PolyDataOf(file));
  BCCSKEL_ASSIGN_OR_RETURN(VtpArrayReader arrays,
                           VtpArrayReader::Make(file, parts.appended, limits.max_file_bytes));
  MeshAssembler mesh(limits);
  CellCollector collector("VTP", mesh);
  uint64_t lines = 0;
  for (const pugi::xml_node piece : polygons.children("Piece")) {
    BCCSKEL_RETURN_IF_ERROR(ReadVtpPiece(piece, arrays, collector));
    lines += piece.attribute("NumberOfLines").as_ullong();
    lines += piece.attribute("NumberOfVerts").as_ullong();
  }
  if (mesh.triangle_count() == 0) return NoPolygonsError("VTP file", mesh.vertex_count(), lines);
  return std::move(mesh).Finish();
}

}  // namespace bccskel
