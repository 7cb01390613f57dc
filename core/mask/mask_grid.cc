#include "core/mask/mask_grid.h"

#include <algorithm>
#include <array>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/volume/volume.h"

namespace bccskel {
namespace {

// The invariants of the volume depend on it: a stray bit would be a point outside the extent.
absl::Status CheckUnusedBits(const MaskGrid& grid, std::span<const uint64_t> words, int32_t z) {
  if (grid.nx % 64 == 0) return absl::OkStatus();
  const uint64_t unused = ~uint64_t{0} << grid.nx % 64;
  for (int32_t y = 0; y < grid.ny; ++y) {
    const size_t last = (static_cast<size_t>(y) + 1) * grid.WordsPerRow() - 1;
    if ((words[last] & unused) != 0) {
      return absl::InvalidArgumentError(absl::StrFormat(
          "slice %d, row %d: a bit is set past the last of %d voxels", z, y, grid.nx));
    }
  }
  return absl::OkStatus();
}

absl::Status CheckSliceSize(const MaskGrid& grid, int32_t z, size_t size, size_t expected) {
  if (z >= grid.nz) {
    return absl::InvalidArgumentError(
        absl::StrFormat("the image has more than the %d slices of its grid", grid.nz));
  }
  if (size == expected) return absl::OkStatus();
  return absl::InvalidArgumentError(absl::StrFormat("slice %d has %d words: %d x %d voxels take %d",
                                                    z, size, grid.nx, grid.ny, expected));
}

int32_t RefinementOf(VoxelPoints points) { return points == VoxelPoints::kTwo ? 1 : 2; }

}  // namespace

absl::Status CheckMaskGrid(const MaskGrid& grid) {
  for (int32_t voxels : {grid.nx, grid.ny, grid.nz}) {
    if (voxels < 1 || voxels > kMaxMaskVoxels) {
      return absl::InvalidArgumentError(
          absl::StrFormat("mask of %d x %d x %d voxels: each axis must have 1 to %d", grid.nx,
                          grid.ny, grid.nz, kMaxMaskVoxels));
    }
  }
  return CheckGrid(ExactExtent(grid, VoxelPoints::kTwo), grid.placement);
}

absl::Status CheckMaskSlice(const MaskGrid& grid, int32_t z, std::span<const uint64_t> words) {
  BCCSKEL_RETURN_IF_ERROR(CheckSliceSize(grid, z, words.size(), grid.WordsPerSlice()));
  return CheckUnusedBits(grid, words, z);
}

absl::Status CheckLabelSlice(const MaskGrid& grid, int32_t z, std::span<const uint64_t> labels) {
  return CheckSliceSize(grid, z, labels.size(), grid.VoxelsPerSlice());
}

std::optional<size_t> AxisOfOneSlice(const MaskGrid& grid) {
  const std::array<int32_t, 3> voxels = {grid.nx, grid.ny, grid.nz};
  if (std::ranges::count(voxels, 1) != 1) return std::nullopt;
  return static_cast<size_t>(std::ranges::find(voxels, 1) - voxels.begin());
}

Placement VoxelPlacement(const MaskGrid& grid) {
  Placement placement = grid.placement;
  const std::optional<size_t> across = AxisOfOneSlice(grid);
  if (!across.has_value()) return placement;
  std::array<double, 3>& spacing = placement.spacing;
  spacing[*across] = std::min(spacing[(*across + 1) % 3], spacing[(*across + 2) % 3]);
  return placement;
}

VoxelParts SlabsOf(const MaskGrid& grid, VoxelPoints points) {
  constexpr double kLongest = 3;       // of a part, in its shortest edges
  constexpr double kTolerance = 1e-6;  // of spacings that were rounded
  constexpr int32_t kMostSlabs = 8;
  const std::array<int64_t, 3> voxels = {grid.nx, grid.ny, grid.nz};
  const std::array<double, 3> spacing = VoxelPlacement(grid).spacing;
  const double longest = kLongest * (1 + kTolerance) * std::ranges::min(spacing);
  VoxelParts slabs = {1, 1, 1};
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto fits = [&](int32_t count) {
      return RefinementOf(points) * count * voxels[axis] < kMaxExtentCells;
    };
    int32_t& count = slabs[axis];
    while (spacing[axis] > count * longest && count < kMostSlabs && fits(count + 1)) ++count;
  }
  return slabs;
}

VoxelParts PartsOf(const MaskGrid& grid, VoxelPoints points) {
  VoxelParts parts = SlabsOf(grid, points);
  for (int32_t& count : parts) count *= RefinementOf(points);
  return parts;
}

LatticeExtent ExactExtent(const MaskGrid& grid, VoxelPoints points) {
  const auto [px, py, pz] = PartsOf(grid, points);
  return {px * grid.nx + 1, py * grid.ny + 1, pz * grid.nz + 1};
}

Placement ExactPlacement(const MaskGrid& grid, VoxelPoints points) {
  Placement placement = VoxelPlacement(grid);
  // Lattice point (0, 0, 0) is the outer corner of voxel (0, 0, 0).
  placement.origin = placement.ToWorld(-1, -1, -1);
  const VoxelParts parts = PartsOf(grid, points);
  for (size_t axis = 0; axis < 3; ++axis) placement.spacing[axis] /= parts[axis];
  return placement;
}

}  // namespace bccskel
