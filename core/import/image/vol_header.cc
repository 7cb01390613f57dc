// DGtal's .vol: keys and values up to a line with a dot; version 3 is compressed by zlib.
#include <array>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/header_text.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

constexpr std::array<std::string_view, 3> kSizes = {"X", "Y", "Z"};
constexpr std::array<std::string_view, 3> kCenters = {"Center-X", "Center-Y", "Center-Z"};

absl::StatusOr<int64_t> CountOf(const HeaderFields& fields, std::string_view key) {
  BCCSKEL_ASSIGN_OR_RETURN(const std::string_view text, fields.Require({key}));
  return RequireNumber<int64_t>(key, text);
}

absl::StatusOr<VoxelType> TypeOf(const HeaderFields& fields) {
  BCCSKEL_ASSIGN_OR_RETURN(const int64_t bytes, CountOf(fields, "Voxel-Size"));
  for (const VoxelType type :
       {VoxelType::kUint8, VoxelType::kUint16, VoxelType::kUint32, VoxelType::kUint64}) {
    if (static_cast<int64_t>(VoxelBytes(type)) == bytes) return type;
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("Voxel-Size is %d bytes, it must be 1, 2, 4 or 8", bytes));
}

// As DGtal does: the voxel at (size - 1) / 2, rounded down, lies at the center.
absl::StatusOr<Placement> PlacementOf(const HeaderFields& fields, const ImageSize& size) {
  Placement placement;
  if (!fields.Find({kCenters[0]}).has_value()) return placement;
  const std::array<int32_t, 3> lengths = {size.nx, size.ny, size.nz};
  for (size_t axis = 0; axis < 3; ++axis) {
    BCCSKEL_ASSIGN_OR_RETURN(const int64_t center, CountOf(fields, kCenters[axis]));
    const int32_t middle = (lengths[axis] - 1) / 2;
    placement.origin[axis] = static_cast<double>(center) - middle;
  }
  return placement;
}

absl::StatusOr<Compression> CompressionOf(const HeaderFields& fields) {
  if (!fields.Find({"Version"}).has_value()) return Compression::kNone;
  BCCSKEL_ASSIGN_OR_RETURN(const int64_t version, CountOf(fields, "Version"));
  if (version == 1 || version == 2) return Compression::kNone;
  if (version == 3) return Compression::kDeflate;
  return absl::InvalidArgumentError(
      absl::StrFormat("Version is %d, it must be 1, 2 or 3", version));
}

HeaderLine Classify(std::string_view line) {
  return Trimmed(line) == "." ? HeaderLine::kEnd : HeaderLine::kField;
}

}  // namespace

bool IsVol(std::string_view front) {
  const auto field = SplitAt(front.substr(0, front.find('\n')), ":");
  if (!field.has_value()) return false;
  for (const std::string_view key : {"X", "Center-X", "Version", "Voxel-Size", "Alpha-Color"}) {
    if (field->first == key) return true;
  }
  return false;
}

absl::StatusOr<StoredImage> ParseVol(const ImageFront& front, const ImageLimits& limits) {
  BCCSKEL_ASSIGN_OR_RETURN(const HeaderFields fields,
                           HeaderFields::Read(front.bytes, {":", Classify}));
  BCCSKEL_ASSIGN_OR_RETURN(const size_t header_bytes, fields.Bytes());
  StoredImage image;
  image.info.format = "vol";
  std::array<int64_t, 3> lengths;
  for (size_t axis = 0; axis < 3; ++axis) {
    BCCSKEL_ASSIGN_OR_RETURN(lengths[axis], CountOf(fields, kSizes[axis]));
  }
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOfAxes(lengths, limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.stored_type, TypeOf(fields));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, PlacementOf(fields, image.info.size));
  BCCSKEL_ASSIGN_OR_RETURN(const Compression compression, CompressionOf(fields));
  BCCSKEL_RETURN_IF_ERROR(PlaceBehindHeader(front, header_bytes, compression, image));
  return image;
}

}  // namespace bccskel
