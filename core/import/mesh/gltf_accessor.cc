#include "core/import/mesh/gltf_accessor.h"

#include <algorithm>
#include <optional>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

// How many numbers a file may contain: a constant, and more per byte of the file. A scene that
// draws each of its meshes a hundred times stays below.
constexpr uint64_t kFreeNumbers = uint64_t{1} << 22;
constexpr uint64_t kNumbersPerByte = 32;

absl::StatusOr<Scalar> ComponentTypeOf(const GltfItem& item) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t type, item.Whole("componentType"));
  switch (type) {
    case 5120:
      return Scalar::kInt8;
    case 5121:
      return Scalar::kUint8;
    case 5122:
      return Scalar::kInt16;
    case 5123:
      return Scalar::kUint16;
    case 5125:
      return Scalar::kUint32;
    case 5126:
      return Scalar::kFloat32;
    default:
      return item.Error(absl::StrFormat("componentType is %d, not one of 5120 to 5126", type));
  }
}

absl::Status CheckIndexType(const GltfItem& item, Scalar type) {
  if (type == Scalar::kUint8 || type == Scalar::kUint16 || type == Scalar::kUint32) {
    return absl::OkStatus();
  }
  return item.Error("indices must be unsigned integers of 8, 16 or 32 bits");
}

// The number that stands for 1 in normalized integers.
std::optional<double> LargestOf(Scalar type) {
  if (IsFloat(type)) return std::nullopt;
  const bool has_sign = type == Scalar::kInt8 || type == Scalar::kInt16;
  return static_cast<double>((uint64_t{1} << (8 * ScalarBytes(type) - (has_sign ? 1 : 0))) - 1);
}

void Normalize(Scalar type, std::vector<double>& values) {
  const std::optional<double> one = LargestOf(type);
  if (!one) return;
  for (double& value : values) value = std::max(value / *one, -1.0);
}

constexpr std::string_view kMeshopt = "EXT_meshopt_compression";

}  // namespace

absl::Status GltfAccessors::Charge(uint64_t numbers) {
  charged_ += numbers;
  const uint64_t limit =
      kFreeNumbers + kNumbersPerByte * (document_bytes_ + buffers_.bytes_of_files());
  if (charged_ <= limit) return absl::OkStatus();
  return absl::ResourceExhaustedError(absl::StrFormat(
      "glTF: the scene draws its meshes so often that it holds %d numbers; the limit for a file of "
      "this length is %d. Draw each mesh once, or export the scene as a single mesh",
      charged_, limit));
}

absl::StatusOr<std::vector<double>> GltfAccessors::Positions(uint64_t index) {
  BCCSKEL_ASSIGN_OR_RETURN(const GltfItem accessor,
                           GltfItem::At(file_.document, "accessors", index));
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar type, ComponentTypeOf(accessor));
  if (accessor.Text("type") != "VEC3" || type == Scalar::kUint32) {
    return accessor.Error("positions must be VEC3 of floats or of integers of 8 or 16 bits");
  }
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<double> values, Read(accessor, 3));
  if (accessor["normalized"] == true) Normalize(type, values);
  return values;
}

absl::StatusOr<std::vector<double>> GltfAccessors::Indices(uint64_t index) {
  BCCSKEL_ASSIGN_OR_RETURN(const GltfItem accessor,
                           GltfItem::At(file_.document, "accessors", index));
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar type, ComponentTypeOf(accessor));
  BCCSKEL_RETURN_IF_ERROR(CheckIndexType(accessor, type));
  if (accessor.Text("type") != "SCALAR") return accessor.Error("indices must be of type SCALAR");
  return Read(accessor, 1);
}

absl::StatusOr<std::vector<double>> GltfAccessors::Read(const GltfItem& accessor,
                                                        uint64_t columns) {
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar type, ComponentTypeOf(accessor));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, accessor.Whole("count"));
  const bool stored = accessor.Has("bufferView");
  if (!stored && !accessor.Has("sparse")) {
    return accessor.Error(
        "has no bufferView, so no numbers; compressed meshes must be exported without compression");
  }
  Rows rows;
  if (stored) {
    BCCSKEL_ASSIGN_OR_RETURN(rows, RowsOf(accessor, count, columns, type));
  }
  BCCSKEL_RETURN_IF_ERROR(Charge(columns * count));
  std::vector<double> values(columns * count);
  for (uint64_t n = 0; stored && n < values.size(); ++n) {
    values[n] = rows.At(n / columns, n % columns);
  }
  BCCSKEL_RETURN_IF_ERROR(ReplaceSparse(accessor, type, columns, values));
  return values;
}

// `owner` has a bufferView and perhaps a byteOffset.
absl::StatusOr<GltfAccessors::Rows> GltfAccessors::RowsOf(const GltfItem& owner, uint64_t count,
                                                          uint64_t columns, Scalar type) {
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t index, owner.Whole("bufferView"));
  BCCSKEL_ASSIGN_OR_RETURN(const GltfItem view, GltfItem::At(file_.document, "bufferViews", index));
  if (view.Inside("extensions").Has(kMeshopt)) {
    return view.Error(
        absl::StrFormat("%s is not read; export the mesh without compression", kMeshopt));
  }
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t buffer_index, view.Whole("buffer"));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t begin, view.WholeOr("byteOffset", 0));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t length, view.Whole("byteLength"));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view buffer, buffers_.Buffer(buffer_index));
  if (begin > buffer.size() || length > buffer.size() - begin) {
    return view.Error(absl::StrFormat("bytes %d to %d are beyond its buffer of %d bytes", begin,
                                      begin + length, buffer.size()));
  }
  const uint64_t row = columns * ScalarBytes(type);
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t stride, view.WholeOr("byteStride", row));
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t offset, owner.WholeOr("byteOffset", 0));
  if (stride < row) {
    return view.Error(
        absl::StrFormat("byteStride is %d, less than the %d bytes of an element", stride, row));
  }
  if (count > 0 && (offset + row > length || (count - 1) > (length - offset - row) / stride)) {
    return owner.Error(absl::StrFormat(
        "%d elements of %d bytes from byte %d, one each %d bytes, are beyond the %d bytes of "
        "bufferViews[%d]",
        count, row, offset, stride, length, index));
  }
  return Rows{buffer.substr(begin + (count > 0 ? offset : 0)), count, stride, columns, type};
}

absl::Status GltfAccessors::ReplaceSparse(const GltfItem& accessor, Scalar type, uint64_t columns,
                                          std::vector<double>& values) {
  if (!accessor.Has("sparse")) return absl::OkStatus();
  const GltfItem sparse = accessor.Inside("sparse");
  const GltfItem places = sparse.Inside("indices");
  BCCSKEL_ASSIGN_OR_RETURN(const uint64_t count, sparse.Whole("count"));
  BCCSKEL_ASSIGN_OR_RETURN(const Scalar place_type, ComponentTypeOf(places));
  BCCSKEL_RETURN_IF_ERROR(CheckIndexType(places, place_type));
  BCCSKEL_ASSIGN_OR_RETURN(const Rows place_rows, RowsOf(places, count, 1, place_type));
  BCCSKEL_ASSIGN_OR_RETURN(const Rows rows, RowsOf(sparse.Inside("values"), count, columns, type));
  BCCSKEL_RETURN_IF_ERROR(Charge(count));
  for (uint64_t n = 0; n < count; ++n) {
    const auto place = static_cast<uint64_t>(place_rows.At(n, 0));
    if (place >= values.size() / columns) {
      return sparse.Error(
          absl::StrFormat("replaces element %d of %d", place, values.size() / columns));
    }
    for (uint64_t column = 0; column < columns; ++column) {
      values[place * columns + column] = rows.At(n, column);
    }
  }
  return absl::OkStatus();
}

}  // namespace bccskel
