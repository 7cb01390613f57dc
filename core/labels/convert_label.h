#ifndef BCCSKEL_CORE_LABELS_CONVERT_LABEL_H_
#define BCCSKEL_CORE_LABELS_CONVERT_LABEL_H_

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/labels/voxel_runs.h"
#include "core/mask/mask_converter.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {

// One label as a bcc object, in the coordinates of the whole image.
// Cost: follows the object, not the image.
// Errors: as MaskConverter.
absl::StatusOr<ConvertedMask> ConvertLabel(const MaskGrid& grid, const LabeledObject& object,
                                           const MaskOptions& options,
                                           const exec::Context& context);

// The same sizes for an object that was made of voxels in this way: those in voxels become points.
PreparingOptions PreparingForMask(PreparingOptions preparing, const MaskGrid& grid,
                                  const MaskOptions& mask);

// The options for such an object: its source, its slabs and PreparingForMask().
SkeletonizeOptions ForMask(SkeletonizeOptions options, const MaskGrid& grid,
                           const MaskOptions& mask);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LABELS_CONVERT_LABEL_H_
