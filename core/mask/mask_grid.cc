#include "core/mask/mask_grid.h"

#include "absl/strings/str_format.h"
#include "core/volume/volume.h"

namespace bccskel {

absl::Status CheckMaskGrid(const MaskGrid& grid) {
  for (int32_t voxels : {grid.nx, grid.ny, grid.nz}) {
    if (voxels < 1 || voxels > kMaxMaskVoxels) {
      return absl::InvalidArgumentError(
          absl::StrFormat("mask of %d x %d x %d voxels: each axis must have 1 to %d", grid.nx,
                          grid.ny, grid.nz, kMaxMaskVoxels));
    }
  }
  return CheckGrid(ExactExtent(grid), grid.placement);
}

LatticeExtent ExactExtent(const MaskGrid& grid) {
  return {2 * grid.nx + 1, 2 * grid.ny + 1, 2 * grid.nz + 1};
}

Placement ExactPlacement(const MaskGrid& grid) {
  Placement placement = grid.placement;
  // Lattice point (0, 0, 0) is the outer corner of voxel (0, 0, 0), one voxel is four units.
  placement.origin = grid.placement.ToWorld(-1, -1, -1);
  for (double& spacing : placement.spacing) spacing /= 2;
  return placement;
}

}  // namespace bccskel
