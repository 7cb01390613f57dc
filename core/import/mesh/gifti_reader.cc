// GIFTI surfaces: one array of points (NIFTI_INTENT_POINTSET) and one of triangles
// (NIFTI_INTENT_TRIANGLE). Coordinates stay as stored: the CoordinateSystemTransformMatrix, which
// leads to another space, is not applied.

#include <bit>
#include <cstdint>
#include <string>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/mesh/cell_collector.h"
#include "core/import/mesh/data_array.h"
#include "core/import/mesh/mesh_assembler.h"
#include "core/import/mesh/mesh_readers.h"
#include "core/import/mesh/stored_bytes.h"
#include "core/import/mesh/xml_document.h"

namespace bccskel {
namespace {

absl::Status GiftiError(const char* attribute, std::string_view found, std::string_view known) {
  return absl::InvalidArgumentError(absl::StrFormat("GIFTI: %s '%s' is not read, only %s",
                                                    attribute, found.substr(0, 40), known));
}

absl::StatusOr<Scalar> GiftiTypeOf(const pugi::xml_node& array) {
  constexpr std::string_view kFront = "NIFTI_TYPE_";
  const std::string_view name = XmlAttribute(array, "DataType");
  if (name.starts_with(kFront)) {
    if (const auto type = ScalarNamed(name.substr(kFront.size())); type) return *type;
  }
  return GiftiError("DataType", name, "integers and floats such as NIFTI_TYPE_FLOAT32");
}

absl::StatusOr<std::endian> GiftiOrderOf(const pugi::xml_node& array) {
  const std::string_view name = XmlAttribute(array, "Endian");
  if (name == "LittleEndian") return std::endian::little;
  if (name == "BigEndian") return std::endian::big;
  return GiftiError("Endian", name, "LittleEndian and BigEndian");
}

// Rows of three values; the number of rows.
absl::StatusOr<uint64_t> GiftiRows(const pugi::xml_node& array) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t rows, XmlCount("GIFTI", array, "Dim0"));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t columns, XmlCount("GIFTI", array, "Dim1"));
  constexpr uint64_t kMostRows = uint64_t{1} << 32;  // of any mesh of ours
  if (columns == 3 && rows <= kMostRows) return rows;
  return absl::InvalidArgumentError(absl::StrFormat(
      "GIFTI: an array of %d x %d values; points and triangles are at most %d rows of 3", rows,
      columns, kMostRows));
}

absl::StatusOr<std::string> GiftiBytes(const pugi::xml_node& array, uint64_t size) {
  StoredBytes stored(array.child("Data").child_value(), StoredBytes::Encoding::kBase64);
  BCCSKEL_ASSIGN_OR_RETURN(std::string bytes, stored.TakeAll());
  const std::string_view encoding = XmlAttribute(array, "Encoding");
  if (encoding == "GZipBase64Binary") return Inflate(bytes, size);
  if (encoding == "Base64Binary") return bytes;
  return GiftiError("Encoding", encoding,
                    "ASCII, Base64Binary and GZipBase64Binary; save the file with one of these");
}

absl::StatusOr<DataArray> GiftiValues(const pugi::xml_node& array, uint64_t count) {
  if (XmlAttribute(array, "Encoding") == "ASCII") {
    return DataArray::FromText("GIFTI", array.child("Data").child_value());
  }
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar type, GiftiTypeOf(array));
  BCCSKEL_ASSIGN_OR_RETURN(const std::endian order, GiftiOrderOf(array));
  BCCSKEL_ASSIGN_OR_RETURN(std::string bytes, GiftiBytes(array, count * ScalarBytes(type)));
  if (bytes.size() % ScalarBytes(type) == 0) return DataArray(std::move(bytes), type, order);
  return absl::InvalidArgumentError(
      absl::StrFormat("GIFTI: an array of %d bytes is no whole number of values of %d bytes",
                      bytes.size(), ScalarBytes(type)));
}

// Row by row, whichever order the file has.
absl::StatusOr<DataArray> GiftiRowsOfThree(const pugi::xml_node& array) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t rows, GiftiRows(array));
  BCCSKEL_ASSIGN_OR_RETURN(DataArray values, GiftiValues(array, 3 * rows));
  if (values.size() != 3 * rows) {
    return absl::InvalidArgumentError(
        absl::StrFormat("GIFTI: an array of %d x 3 values holds %d values", rows, values.size()));
  }
  if (XmlAttribute(array, "ArrayIndexingOrder") != "ColumnMajorOrder") return values;
  DataArray turned;
  for (uint64_t row = 0; row < rows; ++row) {
    for (uint64_t column = 0; column < 3; ++column) turned.Append(values[column * rows + row]);
  }
  return turned;
}

absl::StatusOr<DataArray> GiftiArray(const pugi::xml_node& file, const char* intent) {
  pugi::xml_node found;
  for (const pugi::xml_node array : file.children("DataArray")) {
    if (XmlAttribute(array, "Intent") != intent) continue;
    if (found) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "GIFTI: the file has several arrays %s; save each surface as a file", intent));
    }
    found = array;
  }
  if (found) return GiftiRowsOfThree(found);
  return absl::InvalidArgumentError(
      absl::StrFormat("GIFTI: the file has no array %s. A surface (.surf.gii) has one; maps of "
                      "values (.func.gii, .shape.gii, .label.gii) are no meshes",
                      intent));
}

}  // namespace

absl::StatusOr<TriangleMesh> ParseGifti(std::string_view bytes, const MeshLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const pugi::xml_document document, ParseXml("GIFTI", bytes));
  const pugi::xml_node file = document.child("GIFTI");
  if (!file) return absl::InvalidArgumentError("GIFTI: there is no element <GIFTI>");
  BCCSKEL_ASSIGN_OR_RETURN(const DataArray points, GiftiArray(file, "NIFTI_INTENT_POINTSET"));
  BCCSKEL_ASSIGN_OR_RETURN(const DataArray corners, GiftiArray(file, "NIFTI_INTENT_TRIANGLE"));
  MeshAssembler mesh(limits);
  CellCollector collector("GIFTI", mesh);
  BCCSKEL_RETURN_IF_ERROR(collector.AddPoints(points));
  for (size_t n = 0; n < corners.size(); n += 3) {
    BCCSKEL_RETURN_IF_ERROR(collector.AddCell(FaceShape::kPolygon, corners, n, n + 3));
  }
  return std::move(mesh).Finish();
}

}  // namespace bccskel
