#include "core/labels/convert_label.h"

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

SkeletonizeOptions ForMask(SkeletonizeOptions options, const MaskGrid& grid,
                           const MaskOptions& mask) {
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
