// NIfTI-1 and NIfTI-2, single files and pairs of .hdr and .img, either byte order.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/import/image/image_headers.h"

namespace bccskel {
namespace {

// Where the fields lie, and how wide they are.
struct Layout {
  std::string_view format;
  size_t header_bytes;
  size_t magic, dim, pixdim, datatype, vox_offset, slope, intercept;
  size_t qform, sform, quaternion, qoffset, srow, units;
};
constexpr Layout kNifti1 = {"NIfTI-1", 348, 344, 40,  76,  70,  108, 112,
                            116,       252, 254, 256, 268, 280, 123};
constexpr Layout kNifti2 = {"NIfTI-2", 540, 4,   16,  104, 12,  168, 176,
                            184,       344, 348, 352, 376, 400, 500};
constexpr uint64_t kMinVoxelOffset1 = 352;
constexpr uint64_t kMinVoxelOffset2 = 544;

// Reads fields by the file's byte order. NIfTI-2 has wider ones.
class Fields {
 public:
  Fields(std::string_view bytes, const Layout& layout, std::endian order)
      : bytes_(bytes), layout_(layout), order_(order) {}

  const Layout& layout() const { return layout_; }
  std::endian order() const { return order_; }
  bool wide() const { return &layout_ == &kNifti2; }

  template <typename T>
  T At(size_t offset) const {
    std::array<char, sizeof(T)> raw;
    std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
    if (order_ != std::endian::native) std::reverse(raw.begin(), raw.end());
    return std::bit_cast<T>(raw);
  }
  int64_t Dim(size_t n) const {
    return wide() ? At<int64_t>(layout_.dim + 8 * n) : At<int16_t>(layout_.dim + 2 * n);
  }
  double Float(size_t offset, size_t n = 0) const {
    return wide() ? At<double>(offset + 8 * n) : static_cast<double>(At<float>(offset + 4 * n));
  }
  int32_t Code(size_t offset) const { return wide() ? At<int32_t>(offset) : At<int16_t>(offset); }

 private:
  std::string_view bytes_;
  const Layout& layout_;
  std::endian order_;
};

uint32_t FirstNumber(std::string_view front, std::endian order) {
  uint32_t number = 0;
  for (size_t n = 0; n < 4; ++n) {
    const size_t at = order == std::endian::little ? 3 - n : n;
    number = number << 8 | static_cast<unsigned char>(front[at]);
  }
  return number;
}

std::optional<Fields> FieldsOf(std::string_view front) {
  for (const Layout* layout : {&kNifti1, &kNifti2}) {
    if (front.size() < layout->header_bytes) continue;
    for (const std::endian order : {std::endian::little, std::endian::big}) {
      if (FirstNumber(front, order) == layout->header_bytes) return Fields(front, *layout, order);
    }
  }
  return std::nullopt;
}

absl::StatusOr<VoxelType> TypeOf(const Fields& fields) {
  const int code = fields.At<int16_t>(fields.layout().datatype);
  constexpr std::array<std::pair<int, VoxelType>, 10> kCodes = {{{2, VoxelType::kUint8},
                                                                 {4, VoxelType::kInt16},
                                                                 {8, VoxelType::kInt32},
                                                                 {16, VoxelType::kFloat32},
                                                                 {64, VoxelType::kFloat64},
                                                                 {256, VoxelType::kInt8},
                                                                 {512, VoxelType::kUint16},
                                                                 {768, VoxelType::kUint32},
                                                                 {1024, VoxelType::kInt64},
                                                                 {1280, VoxelType::kUint64}}};
  for (const auto& [number, type] : kCodes) {
    if (number == code) return type;
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("datatype %d is not one of plain numbers (RGB and complex voxels have "
                      "several components: choose one)",
                      code));
}

absl::StatusOr<ImageSize> SizeOf(const Fields& fields, const ImageLimits& limits) {
  const int64_t axes = fields.Dim(0);
  if (axes < 1 || axes > 7) {
    return absl::InvalidArgumentError(absl::StrFormat("dim[0] is %d, it must be 1 to 7", axes));
  }
  std::array<int64_t, 7> lengths;
  for (size_t n = 0; n < 7; ++n) lengths[n] = fields.Dim(n + 1);
  return SizeOfAxes(std::span(lengths).first(static_cast<size_t>(axes)), limits);
}

absl::StatusOr<Placement> PlacementOfSform(const Fields& fields,
                                           const std::array<double, 3>& spacing) {
  std::array<WorldPoint, 3> steps;
  WorldPoint origin;
  for (size_t row = 0; row < 3; ++row) {
    for (size_t axis = 0; axis < 3; ++axis) {
      steps[axis][row] = fields.Float(fields.layout().srow, 4 * row + axis);
    }
    origin[row] = fields.Float(fields.layout().srow, 4 * row + 3);
  }
  return PlacementOfSteps(steps, origin, spacing);
}

// The standard's formula for the rotation of the unit quaternion (a, b, c, d).
absl::StatusOr<Placement> PlacementOfQform(const Fields& fields,
                                           const std::array<double, 3>& spacing) {
  const auto q = [&fields](size_t n) { return fields.Float(fields.layout().quaternion, n); };
  const auto at = [&fields](size_t n) { return fields.Float(fields.layout().qoffset, n); };
  // Rounding may make it longer than 1.
  const double length = std::max(1.0, std::hypot(q(0), q(1), q(2)));
  const double b = q(0) / length, c = q(1) / length, d = q(2) / length;
  const double a = std::sqrt(std::max(0.0, 1 - (b * b + c * c + d * d)));
  const double handedness = fields.Float(fields.layout().pixdim) < 0 ? -1 : 1;
  std::array<WorldPoint, 3> steps = {{
      {a * a + b * b - c * c - d * d, 2 * (b * c + a * d), 2 * (b * d - a * c)},
      {2 * (b * c - a * d), a * a + c * c - b * b - d * d, 2 * (c * d + a * b)},
      {2 * (b * d + a * c), 2 * (c * d - a * b), a * a + d * d - b * b - c * c},
  }};
  for (size_t axis = 0; axis < 3; ++axis) {
    for (double& step : steps[axis]) step *= spacing[axis] * (axis == 2 ? handedness : 1);
  }
  return PlacementOfSteps(steps, {at(0), at(1), at(2)}, spacing);
}

// Codes of 0, as of files that were Analyze once, do not say where axes point: readers guess, each
// in its way.
bool StatesOrientation(const Fields& fields) {
  return fields.Code(fields.layout().sform) > 0 || fields.Code(fields.layout().qform) > 0;
}

absl::StatusOr<Placement> PlacementOf(const Fields& fields) {
  std::array<double, 3> spacing = {1, 1, 1};
  for (size_t axis = 0; axis < 3; ++axis) {
    if (static_cast<int64_t>(axis) >= fields.Dim(0)) break;
    spacing[axis] = std::abs(fields.Float(fields.layout().pixdim, axis + 1));
    // A single slice has no next one, so some writers leave 0.
    if (spacing[axis] == 0 && fields.Dim(axis + 1) == 1) spacing[axis] = 1;
  }
  if (fields.Code(fields.layout().sform) > 0) return PlacementOfSform(fields, spacing);
  if (fields.Code(fields.layout().qform) > 0) return PlacementOfQform(fields, spacing);
  return PlacementOfSpacing(spacing, {0, 0, 0});
}

std::string UnitOf(const Fields& fields) {
  const int code = fields.wide()
                       ? fields.Code(fields.layout().units)
                       : static_cast<unsigned char>(fields.At<char>(fields.layout().units));
  constexpr std::array<const char*, 4> kUnits = {"", "m", "mm", "um"};
  const auto length = static_cast<size_t>(code & 7);
  return length < kUnits.size() ? kUnits[length] : "";
}

// Slope 0 means that values are what is stored, and so does what is not a number.
absl::Status SetScaling(const Fields& fields, StoredImage& image) {
  const double slope = fields.Float(fields.layout().slope);
  const double intercept = fields.Float(fields.layout().intercept);
  if (slope == 0 || std::isnan(slope)) return absl::OkStatus();
  image.slope = slope;
  image.intercept = std::isnan(intercept) ? 0 : intercept;
  if (std::isfinite(image.slope) && std::isfinite(image.intercept)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("scl_slope %g and scl_inter %g must be finite", slope, intercept));
}

absl::StatusOr<uint64_t> VoxelOffset(const Fields& fields, uint64_t least) {
  const double offset = fields.wide()
                            ? static_cast<double>(fields.At<int64_t>(fields.layout().vox_offset))
                            : fields.Float(fields.layout().vox_offset);
  constexpr double kMost = 1e15;
  if (offset >= static_cast<double>(least) && offset < kMost && offset == std::floor(offset)) {
    return static_cast<uint64_t>(offset);
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("vox_offset is %g, it must be a whole number from %d on", offset, least));
}

// "brain.img" for "folder/brain.hdr.gz".
std::string PairName(const std::string& header) {
  std::string name = header.substr(header.rfind('/') + 1);
  const bool gzip = name.ends_with(".gz");
  if (gzip) name.resize(name.size() - 3);
  return name.substr(0, name.rfind('.')) + (gzip ? ".img.gz" : ".img");
}

absl::Status PlaceVoxels(const ImageFront& front, const Fields& fields, StoredImage& image) {
  const std::string magic = front.bytes.substr(fields.layout().magic, 3);
  const std::string number = fields.wide() ? "2" : "1";
  if (magic == "n+" + number) {
    const uint64_t least = fields.wide() ? kMinVoxelOffset2 : kMinVoxelOffset1;
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t offset, VoxelOffset(fields, least));
    return PlaceBehindHeader(front, offset, Compression::kNone, image);
  }
  if (magic == "ni" + number) {
    BCCSKEL_ASSIGN_OR_RETURN(const uint64_t offset, VoxelOffset(fields, 0));
    return PlaceInFile(front, PairName(front.file->name()), offset, front.compression, image);
  }
  return absl::InvalidArgumentError(
      "the header has the length of NIfTI's but not its magic; Analyze files are not supported");
}

}  // namespace

bool IsNifti(std::string_view front) { return FieldsOf(front).has_value(); }

absl::StatusOr<StoredImage> ParseNifti(const ImageFront& front, const ImageLimits& limits) {
  const std::optional<Fields> fields = FieldsOf(front.bytes);
  if (!fields.has_value()) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "not a NIfTI header: its first number is neither 348 nor 540, or it is cut (%d bytes)",
        front.bytes.size()));
  }
  StoredImage image;
  image.info.format = std::string(fields->layout().format);
  image.info.world = StatesOrientation(*fields) ? "RAS" : "";
  image.info.unit = UnitOf(*fields);
  image.byte_order = fields->order();
  BCCSKEL_ASSIGN_OR_RETURN(image.info.size, SizeOf(*fields, limits));
  BCCSKEL_ASSIGN_OR_RETURN(image.stored_type, TypeOf(*fields));
  BCCSKEL_ASSIGN_OR_RETURN(image.info.placement, PlacementOf(*fields));
  BCCSKEL_RETURN_IF_ERROR(SetScaling(*fields, image));
  BCCSKEL_RETURN_IF_ERROR(PlaceVoxels(front, *fields, image));
  return image;
}

}  // namespace bccskel
