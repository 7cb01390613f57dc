#include "core/labels/convert_label.h"

#include <cmath>
#include <utility>

#include "core/exec/status_macros.h"

namespace bccskel {

absl::StatusOr<ConvertedMask> ConvertLabel(const MaskGrid& grid, const LabeledObject& object,
                                           const MaskOptions& options,
                                           const exec::Context& context) {
  BCCSKEL_ASSIGN_OR_RETURN(MaskConverter converter, MaskConverter::Create(grid, options));
  SliceRows rows;
  for (auto run = object.runs.begin(); run != object.runs.end();) {
    const int32_t z = run->z;
    rows.Clear();
    for (; run != object.runs.end() && run->z == z; ++run)
      rows.AddRun(run->y, run->begin, run->end);
    BCCSKEL_RETURN_IF_ERROR(converter.AddRows(z, rows, context));
  }
  return std::move(converter).FinishRows();
}

namespace {

// The points of a cube of voxels: the centers of their parts and the corners.
double PointsOfCube(double edge, const VoxelParts& parts) {
  double centers = 1, corners = 1;
  for (const int32_t count : parts) {
    centers *= count * edge;
    corners *= count * edge + 1;
  }
  return centers + corners;
}

double EdgeOfCube(double points) {
  double least = 0, most = std::cbrt(points);
  constexpr int kHalvings = 60;
  for (int n = 0; n < kHalvings; ++n) {
    const double edge = (least + most) / 2;
    (PointsOfCube(edge, {1, 1, 1}) < points ? least : most) = edge;
  }
  return most;
}

}  // namespace

PreparingOptions PreparingForMask(PreparingOptions preparing, const MaskGrid& grid,
                                  const MaskOptions& mask) {
  if (preparing.component_size == ComponentSize::kPoints) return preparing;
  preparing.component_size = ComponentSize::kPoints;
  const auto points = static_cast<double>(preparing.min_component_points);
  const double same = mask.sampling.has_value()
                          ? points * mask.sampling->points_per_voxel / 2
                          : PointsOfCube(EdgeOfCube(points), PartsOf(grid, mask.points));
  preparing.min_component_points = static_cast<uint64_t>(std::llround(same));
  return preparing;
}

SkeletonizeOptions ForMask(SkeletonizeOptions options, const MaskGrid& grid,
                           const MaskOptions& mask) {
  options.preparing = PreparingForMask(options.preparing, grid, mask);
  const bool two = mask.points == VoxelPoints::kTwo;
  options.source = two ? ObjectSource::kVoxels : ObjectSource::kRefinedVoxels;
  if (mask.sampling) {
    options.source = ObjectSource::kSampledVoxels;
  } else {
    options.voxel_slabs = SlabsOf(grid, mask.points);
  }
  return options;
}

}  // namespace bccskel
