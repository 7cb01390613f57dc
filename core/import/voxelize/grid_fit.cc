#include "core/import/voxelize/grid_fit.h"

#include <cmath>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/volume/volume.h"

namespace bccskel {
namespace {

// Unlike each other and less than the margin of half a lattice unit.
constexpr std::array<double, 3> kOffCenterUnits = {0.31, -0.23, 0.37};

}  // namespace

GridPoint GridFit::Snap(const TriangleMesh::Vertex& unit) const {
  constexpr double kTicks = 1 << kTickBits;
  const auto snap = [&](size_t axis) {
    return std::llround((offset[axis] + unit[axis] * scale) * kTicks);
  };
  return {snap(0), snap(1), snap(2)};
}

absl::StatusOr<GridFit> FitGrid(const Surface& surface, double unit_spacing, GridShift shift) {
  GridFit fit;
  fit.scale = 2 / unit_spacing;
  std::array<int32_t*, 3> cells = {&fit.extent.nx, &fit.extent.ny, &fit.extent.nz};
  fit.placement.spacing.fill(unit_spacing * surface.half_size * 2);
  for (size_t axis = 0; axis < 3; ++axis) {
    const double length = surface.upper_unit[axis];
    const double needed = std::ceil(length / unit_spacing) + 1;
    if (!(needed <= kMaxExtentCells)) {
      return absl::ResourceExhaustedError(absl::StrFormat(
          "the grid needs %.6g cells along %c, the limit is %d: choose a larger spacing, fewer "
          "points, or remove far outliers from the mesh",
          needed, "xyz"[axis], kMaxExtentCells));
    }
    *cells[axis] = static_cast<int32_t>(needed);
    fit.offset[axis] = needed - 0.5 - length / 2 * fit.scale;
    if (shift == GridShift::kOffCenter) fit.offset[axis] += kOffCenterUnits[axis];
    fit.placement.origin[axis] =
        surface.lower[axis] - fit.offset[axis] * (unit_spacing / 2) * surface.half_size * 2;
  }
  BCCSKEL_RETURN_IF_ERROR(CheckGrid(fit.extent, fit.placement));
  return fit;
}

}  // namespace bccskel
