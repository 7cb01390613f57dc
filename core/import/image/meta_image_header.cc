// MetaImage, as ITK and VTK write it: keys and values, the last of them ElementDataFile.
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"
#include "core/lattice/length_unit.h"

namespace bccskel {
namespace {

struct TypeName {
  VoxelType type;
  std::string_view name;
};
constexpr std::array<TypeName, 12> kMetaTypes = {{
    {VoxelType::kInt8, "MET_CHAR"},
    {VoxelType::kUint8, "MET_UCHAR"},
    {VoxelType::kInt16, "MET_SHORT"},
    {VoxelType::kUint16, "MET_USHORT"},
    {VoxelType::kInt32, "MET_INT"},
    {VoxelType::kUint32, "MET_UINT"},
    {VoxelType::kInt32, "MET_LONG"},  // 4 bytes, whatever the machine calls long
    {VoxelType::kUint32, "MET_ULONG"},
    {VoxelType::kInt64, "MET_LONG_LONG"},
    {VoxelType::kUint64, "MET_ULONG_LONG"},
    {VoxelType::kFloat32, "MET_FLOAT"},
    {VoxelType::kFloat64, "MET_DOUBLE"},
}};

absl::StatusOr<VoxelType> MetaTypeOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view name, fields.Require({"ElementType"}));
  for (const TypeName& entry : kMetaTypes) {
    if (name == entry.name) return entry.type;
  }
  return BadField("ElementType", name, "is not a type of numbers");
}

bool IsTrue(const HeaderFields& fields, std::initializer_list<std::string_view> keys) {
  const std::string_view value = fields.Find(keys).value_or("False");
  return value.starts_with('T') || value.starts_with('t') || value.starts_with('1');
}

absl::Status CheckMetaSupported(const HeaderFields& fields) {
  if (fields.Find({"BinaryData"}).has_value() && !IsTrue(fields, {"BinaryData"})) {
    return absl::UnimplementedError("voxels as text (BinaryData = False) are not supported");
  }
  const std::string_view channels = fields.Find({"ElementNumberOfChannels"}).value_or("1");
  if (channels == "1") return absl::OkStatus();
  return BadField("ElementNumberOfChannels", channels,
                  "must be 1: save one channel as an image of its own");
}

absl::StatusOr<std::vector<int64_t>> MetaSizesOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view dimensions, fields.Require({"NDims"}));
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, fields.Require({"DimSize"}));
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<int64_t> sizes, ParseNumbers<int64_t>("DimSize", text));
  if (ParseNumber<size_t>(dimensions) == sizes.size()) return sizes;
  return absl::InvalidArgumentError(absl::StrFormat("NDims is '%s' but DimSize has %d numbers",
                                                    std::string(dimensions.substr(0, 80)),
                                                    sizes.size()));
}

// The numbers of a field that is there, one for each of `wanted`; none where it is not.
absl::StatusOr<std::vector<double>> MetaNumbersOf(const HeaderFields& fields,
                                                  std::initializer_list<std::string_view> keys,
                                                  size_t wanted) {
  const std::optional<std::string_view> text = fields.Find(keys);
  if (!text.has_value()) return std::vector<double>();
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<double> numbers, ParseNumbers<double>(*keys.begin(), *text));
  if (numbers.size() == wanted) return numbers;
  return absl::InvalidArgumentError(absl::StrFormat(
      "%s has %d numbers, it needs %d", std::string(*keys.begin()), numbers.size(), wanted));
}

// Row n of the TransformMatrix is where axis n points to.
absl::StatusOr<Placement> MetaPlacementOf(const HeaderFields& fields, size_t dimensions) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> spacing,
                           MetaNumbersOf(fields, {"ElementSpacing", "ElementSize"}, dimensions));
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> offset,
                           MetaNumbersOf(fields, {"Offset", "Position", "Origin"}, dimensions));
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<double> matrix,
                           MetaNumbersOf(fields, {"TransformMatrix", "Orientation", "Rotation"},
                                         dimensions * dimensions));
  std::array<WorldPoint, 3> steps = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
  WorldPoint origin = {0, 0, 0};
  for (size_t axis = 0; axis < std::min<size_t>(3, dimensions); ++axis) {
    if (!offset.empty()) origin[axis] = offset[axis];
    for (size_t n = 0; n < std::min<size_t>(3, dimensions); ++n) {
      if (!matrix.empty()) steps[axis][n] = matrix[axis * dimensions + n];
      if (!spacing.empty()) steps[axis][n] *= spacing[axis];
    }
  }
  std::optional<std::array<double, 3>> stated;
  if (spacing.size() >= 3) stated = {spacing[0], spacing[1], spacing[2]};
  return PlacementOfSteps(steps, origin, stated);
}

absl::Status PlaceMetaVoxels(const ImageFront& front, const HeaderFields& fields,
                             StoredImage& image) {
  BCCSKEL_ASSIGN_OR_RETURN(const size_t header_bytes, fields.Bytes());
  const bool compressed = IsTrue(fields, {"CompressedData"});
  const Compression inner = compressed ? Compression::kDeflate : Compression::kNone;
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view file, fields.Require({"ElementDataFile"}));
  if (LowerCase(file) == "local") return PlaceBehindHeader(front, header_bytes, inner, image);
  const std::string_view skip = fields.Find({"HeaderSize"}).value_or("0");
  return PlaceDetached(front, file, "HeaderSize", skip, inner, image);
}

HeaderLine ClassifyMetaLine(std::string_view line) {
  if (Trimmed(line).empty()) return HeaderLine::kIgnored;
  const auto field = SplitAt(line, "=");
  const bool last = field.has_value() && field->first == "ElementDataFile";
  return last ? HeaderLine::kLastField : HeaderLine::kField;
}

// ITK's world, which points left, to the back and up; MetaImages of other origin do not say.
std::string MetaWorldOf(const HeaderFields& fields) {
  return fields.Find({"AnatomicalOrientation"}).has_value() ? "LPS" : "";
}

}  // namespace

bool IsMetaImage(std::string_view front) {
  const std::string_view line = front.substr(0, front.find('\n'));
  const auto field = SplitAt(line, "=");
  if (!field.has_value()) return false;
  return field->first == "ObjectType" || field->first == "NDims" || field->first == "Comment";
}

absl::StatusOr<StoredImage> ParseMetaImage(const ImageFront& front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const HeaderFields fields,
                           HeaderFields::Read(front.bytes, {"=", ClassifyMetaLine}));
  BCCSKEL_RETURN_IF_ERROR(CheckMetaSupported(fields));
  StoredImage image;
  image.info.format = "MetaImage";
  BCCSKEL_ASSIGN_OR_RETURN(const std::vector<int64_t> sizes, MetaSizesOf(fields));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOfAxes(sizes, limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.stored_type, MetaTypeOf(fields));
  if (IsTrue(fields, {"BinaryDataByteOrderMSB", "ElementByteOrderMSB"})) {
    image.byte_order = std::endian::big;
  }
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, MetaPlacementOf(fields, sizes.size()));
  image.info.unit = UnitNamed(fields.Find({"DistanceUnits"}).value_or(""));
  image.info.world = MetaWorldOf(fields);
  BCCSKEL_RETURN_IF_ERROR(PlaceMetaVoxels(front, fields, image));
  return image;
}

}  // namespace bccskel
