#ifndef BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_INFO_H_
#define BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_INFO_H_

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/import/image/image_limits.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {

enum class VoxelType {
  kUint8,
  kInt8,
  kUint16,
  kInt16,
  kUint32,
  kInt32,
  kUint64,
  kInt64,
  kFloat32,
  kFloat64,
};

// "uint8", "float32", ...
std::string_view VoxelTypeName(VoxelType type);
// The type of a name: those of VoxelTypeName() and the short ones, "u8", "i16", "f32", ...
// Errors: INVALID_ARGUMENT, lists the names.
absl::StatusOr<VoxelType> ParseVoxelType(const std::string& name);
uint64_t VoxelBytes(VoxelType type);

// Voxels along each axis; x varies fastest.
struct ImageSize {
  int32_t nx = 0;
  int32_t ny = 0;
  int32_t nz = 0;

  friend constexpr bool operator==(const ImageSize&, const ImageSize&) = default;
  constexpr uint64_t SliceVoxels() const {
    return static_cast<uint64_t>(nx) * static_cast<uint64_t>(ny);
  }
  constexpr uint64_t Voxels() const { return SliceVoxels() * static_cast<uint64_t>(nz); }
};

// What an image says about itself before its voxels are read.
struct ImageInfo {
  std::string format;  // "NIfTI-1", "NRRD", ...
  ImageSize size;
  VoxelType type = VoxelType::kUint8;  // of the values that slices give
  // Of the voxels' centers: `origin` is the center of voxel (0, 0, 0), and voxel (i, j, k) lies at
  // ToWorld(2 * i, 2 * j, 2 * k). The world is that of the file, see core/import/image/README.md.
  Placement placement;
  std::string unit;   // of the world's coordinates: "mm", "um", ...; empty where unknown
  std::string world;  // what its axes point to: "RAS", "LPS", ...; empty where unknown
};

// The size of an image from the lengths of its axes, fastest first. Missing axes and those behind
// the third count 1.
// Errors: INVALID_ARGUMENT for no axis, a length below 1, and a fourth axis that is longer than 1;
//         RESOURCE_EXHAUSTED for an axis, a slice or an image over its limit.
absl::StatusOr<ImageSize> SizeOfAxes(std::span<const int64_t> lengths, const ImageLimits& limits);

// Errors: INVALID_ARGUMENT for a spacing that is not positive or numbers that are not finite.
absl::StatusOr<Placement> PlacementOfSpacing(const std::array<double, 3>& spacing,
                                             const WorldPoint& origin);

// `steps[n]` leads from a voxel to the next one along axis n. Steps along an oblique axis are
// rounded, so their lengths are, too. Lengths that the file states replace those that differ by
// rounding alone: equal spacings must not seem to differ.
// Errors: INVALID_ARGUMENT for numbers that are not finite, steps of length zero, and axes that are
//         not perpendicular: distances in a sheared image are not those of the lattice.
absl::StatusOr<Placement> PlacementOfSteps(
    const std::array<WorldPoint, 3>& steps, const WorldPoint& origin,
    const std::optional<std::array<double, 3>>& stated = std::nullopt);

// The same place with another spacing. Errors: as PlacementOfSpacing().
absl::StatusOr<Placement> WithSpacing(const Placement& placement,
                                      const std::array<double, 3>& spacing);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_IMAGE_IMAGE_INFO_H_
