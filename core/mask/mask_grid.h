#ifndef BCCSKEL_CORE_MASK_MASK_GRID_H_
#define BCCSKEL_CORE_MASK_MASK_GRID_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

#include "absl/status/status.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {

// Which voxels of a cubic mask touch each other, object first: the two conventions for which the
// topologies of object and background are consistent.
enum class MaskAdjacency : uint8_t {
  k26,  // (26, 6): object voxels that share a corner are connected
  k6,   // (6, 26): only those that share a face
};

// The lattice points that an exact conversion creates per voxel of a solid object. Both keep the
// topology.
enum class VoxelPoints : uint8_t {
  kTwo,      // the center of the voxel and a corner
  kSixteen,  // the same of a mask refined 2 x 2 x 2, for finer curves
};

// The number of equal parts into which voxels are cut along x, y and z.
using VoxelParts = std::array<int32_t, 3>;

// Largest number of voxels along an axis: with sixteen points per voxel, n voxels take 2 n + 1
// cells.
inline constexpr int32_t kMaxMaskVoxels = (kMaxExtentCells - 1) / 2;

// A grid of voxels. Here `placement` places voxel centers: `spacing` is the size of a voxel,
// `origin` the world position of the center of voxel (0, 0, 0). Everything outside is background.
struct MaskGrid {
  int32_t nx = 0;
  int32_t ny = 0;
  int32_t nz = 0;
  Placement placement = {};

  // A slice of a mask is all voxels of one z: row y begins at word y * WordsPerRow(), voxel x of it
  // is bit x % 64 of word x / 64, and bits from nx on are zero.
  size_t WordsPerRow() const { return (static_cast<size_t>(nx) + 63) / 64; }
  size_t WordsPerSlice() const { return WordsPerRow() * static_cast<size_t>(ny); }
  // A slice of labels holds one value per voxel, x fastest.
  size_t VoxelsPerSlice() const { return static_cast<size_t>(nx) * static_cast<size_t>(ny); }

  friend bool operator==(const MaskGrid&, const MaskGrid&) = default;
};

// OK when each axis has 1..kMaxMaskVoxels voxels and the placement is finite with a positive
// spacing.
absl::Status CheckMaskGrid(const MaskGrid& grid);

// OK for slice z of a mask or of labels: z < nz, as many words as MaskGrid says, and in a mask no
// bit set past the last voxel of a row.
absl::Status CheckMaskSlice(const MaskGrid& grid, int32_t z, std::span<const uint64_t> words);
absl::Status CheckLabelSlice(const MaskGrid& grid, int32_t z, std::span<const uint64_t> labels);

// The axis along which an image has a single slice, as a 2-D image has; no value for an image of a
// single row.
std::optional<size_t> AxisOfOneSlice(const MaskGrid& grid);

// The placement of voxels on the lattice: that of the image, except that voxels of an image of one
// slice count as long across the slice as they are wide. The object continues beyond that slice
// (core/pipeline), so its thickness is no part of the shape, and curves would zigzag through a
// thick one.
Placement VoxelPlacement(const MaskGrid& grid);

// The slabs that make the parts of voxels at most three times as long as wide: at most eight, and
// as many as the extent allows. On longer parts curves would fork and end early (README.md). The
// parts touch each other as the voxels do, so the topology is the same.
VoxelParts SlabsOf(const MaskGrid& grid, VoxelPoints points);

// All parts of an exact conversion: the slabs, each cut in two along each axis for sixteen points.
VoxelParts PartsOf(const MaskGrid& grid, VoxelPoints points);

// The lattice of an exact conversion: its odd points are the centers of the parts of voxels, its
// even points their corners. World positions are those of the voxels.
LatticeExtent ExactExtent(const MaskGrid& grid, VoxelPoints points);
Placement ExactPlacement(const MaskGrid& grid, VoxelPoints points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_MASK_GRID_H_
