#include "core/import/image/image_info.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "absl/strings/numbers.h"
#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"

namespace bccskel {
namespace {

struct TypeEntry {
  VoxelType type;
  std::string_view name;
  std::string_view short_name;
  uint64_t bytes;
};

// In the order of VoxelType.
constexpr std::array<TypeEntry, 10> kTypes = {{
    {VoxelType::kUint8, "uint8", "u8", 1},
    {VoxelType::kInt8, "int8", "i8", 1},
    {VoxelType::kUint16, "uint16", "u16", 2},
    {VoxelType::kInt16, "int16", "i16", 2},
    {VoxelType::kUint32, "uint32", "u32", 4},
    {VoxelType::kInt32, "int32", "i32", 4},
    {VoxelType::kUint64, "uint64", "u64", 8},
    {VoxelType::kInt64, "int64", "i64", 8},
    {VoxelType::kFloat32, "float32", "f32", 4},
    {VoxelType::kFloat64, "float64", "f64", 8},
}};

const TypeEntry& EntryOf(VoxelType type) { return kTypes[static_cast<size_t>(type)]; }

// Rounded numbers in a header make axes lean by about 1e-6; a real shear is larger than this.
constexpr double kMaxLean = 1e-3;

// Of a step in single precision, or in text of as many digits.
constexpr double kMaxRounding = 2e-6;

// Steps in double precision are off in the last digits.
double WithoutLastDigits(double length) {
  double number = length;
  return absl::SimpleAtod(absl::StrFormat("%.13g", length), &number) ? number : length;
}

using Spacing = std::array<double, 3>;

Spacing LengthsOf(const std::array<WorldPoint, 3>& steps, const std::optional<Spacing>& stated) {
  const bool oblique = std::ranges::any_of(
      steps, [](const WorldPoint& step) { return std::ranges::count(step, 0.0) < 2; });
  Spacing lengths;
  for (size_t axis = 0; axis < 3; ++axis) {
    lengths[axis] = LengthOf(steps[axis]);
    const double other = stated.has_value() ? (*stated)[axis] : 0;
    if (std::abs(lengths[axis] - other) <= kMaxRounding * other) {
      lengths[axis] = other;
    } else if (oblique) {
      lengths[axis] = WithoutLastDigits(lengths[axis]);
    }
  }
  return lengths;
}

bool IsFinite(const WorldPoint& p) {
  return std::ranges::all_of(p, [](double c) { return std::isfinite(c); });
}

absl::Status CheckOrigin(const WorldPoint& origin) {
  if (IsFinite(origin)) return absl::OkStatus();
  return absl::InvalidArgumentError(
      absl::StrFormat("origin (%g, %g, %g) is not finite", origin[0], origin[1], origin[2]));
}

std::string ListOf(std::span<const int64_t> lengths) {
  std::string list;
  for (const int64_t length : lengths) {
    absl::StrAppendFormat(&list, "%s%d", list.empty() ? "" : " x ", length);
  }
  return list;
}

absl::Status CheckAxes(std::span<const int64_t> lengths, const ImageLimits& limits) {
  if (lengths.empty()) return absl::InvalidArgumentError("the image has no axes");
  for (size_t n = 0; n < lengths.size(); ++n) {
    if (lengths[n] < 1) {
      return absl::InvalidArgumentError(
          absl::StrFormat("size %s: axis %d holds %d voxels, it must be at least 1",
                          ListOf(lengths), n, lengths[n]));
    }
    if (n >= 3 && lengths[n] > 1) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "the image has %d axes (%s); only 3 are read: save one channel or point of "
          "time as an image of its own",
          lengths.size(), ListOf(lengths)));
    }
    if (lengths[n] > limits.max_axis_voxels) {
      return absl::ResourceExhaustedError(
          absl::StrFormat("size %s: axis %d holds %d voxels, the limit is %d", ListOf(lengths), n,
                          lengths[n], limits.max_axis_voxels));
    }
  }
  return absl::OkStatus();
}

}  // namespace

std::string_view VoxelTypeName(VoxelType type) { return EntryOf(type).name; }

uint64_t VoxelBytes(VoxelType type) { return EntryOf(type).bytes; }

absl::StatusOr<VoxelType> ParseVoxelType(const std::string& name) {
  std::string names;
  for (const TypeEntry& entry : kTypes) {
    if (name == entry.name || name == entry.short_name) return entry.type;
    names += (names.empty() ? "" : ", ") + std::string(entry.short_name);
  }
  return absl::InvalidArgumentError(
      absl::StrFormat("'%s' is not a voxel type; there are %s", name, names));
}

absl::StatusOr<ImageSize> SizeOfAxes(std::span<const int64_t> lengths, const ImageLimits& limits) {
  BCCSKEL_RETURN_IF_ERROR(CheckAxes(lengths, limits));
  const auto length = [&lengths](size_t axis) {
    return axis < lengths.size() ? static_cast<int32_t>(lengths[axis]) : 1;
  };
  // Each length is below 2^22, so the slice is compared before the third factor may overflow.
  const ImageSize size = {length(0), length(1), length(2)};
  if (size.SliceVoxels() > limits.max_slice_voxels) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("a slice of %d x %d holds %d voxels, the limit is %d", size.nx, size.ny,
                        size.SliceVoxels(), limits.max_slice_voxels));
  }
  if (size.Voxels() > limits.max_voxels) {
    return absl::ResourceExhaustedError(
        absl::StrFormat("the image of %d x %d x %d holds %d voxels, the limit is %d", size.nx,
                        size.ny, size.nz, size.Voxels(), limits.max_voxels));
  }
  return size;
}

absl::StatusOr<Placement> PlacementOfSpacing(const std::array<double, 3>& spacing,
                                             const WorldPoint& origin) {
  for (const double step : spacing) {
    if (std::isfinite(step) && step > 0) continue;
    return absl::InvalidArgumentError(absl::StrFormat(
        "spacing %g x %g x %g must be finite and positive", spacing[0], spacing[1], spacing[2]));
  }
  BCCSKEL_RETURN_IF_ERROR(CheckOrigin(origin));
  return Placement{.spacing = spacing, .origin = origin};
}

absl::StatusOr<Placement> PlacementOfSteps(const std::array<WorldPoint, 3>& steps,
                                           const WorldPoint& origin,
                                           const std::optional<std::array<double, 3>>& stated) {
  const Spacing spacing = LengthsOf(steps, stated);
  BCCSKEL_ASSIGN_OR_RETURN(Placement placement, PlacementOfSpacing(spacing, origin));
  for (size_t axis = 0; axis < 3; ++axis) {
    const double length = LengthOf(steps[axis]);
    for (size_t row = 0; row < 3; ++row) {
      placement.direction[3 * row + axis] = steps[axis][row] / length;
    }
    const size_t next = (axis + 1) % 3;
    const double lean = std::abs(Dot(steps[axis], steps[next])) / spacing[axis] / spacing[next];
    if (!(lean <= kMaxLean)) {
      return absl::InvalidArgumentError(
          absl::StrFormat("axes %d and %d are not perpendicular: the cosine between them is %g, "
                          "the limit is %g; resample the image without shear",
                          axis, next, lean, kMaxLean));
    }
  }
  return placement;
}

absl::StatusOr<Placement> WithSpacing(const Placement& placement,
                                      const std::array<double, 3>& spacing) {
  BCCSKEL_ASSIGN_OR_RETURN(Placement result, PlacementOfSpacing(spacing, placement.origin));
  result.direction = placement.direction;
  return result;
}

}  // namespace bccskel
