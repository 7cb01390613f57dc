#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {
namespace {

bool IsForSheets(PruningRule rule) {
  return rule == PruningOptions().rule || rule == PruningRule::kNone;
}

}  // namespace

double SurfaceStepOf(ObjectSource source) {
  switch (source) {
    case ObjectSource::kPoints:
      return 1;
    case ObjectSource::kVoxels:
    case ObjectSource::kSampledVoxels:
      return 2;
    case ObjectSource::kRefinedVoxels:
      return 4;
  }
  return 1;
}

absl::Status CheckSkeletonizeOptions(const SkeletonizeOptions& options) {
  BCCSKEL_RETURN_IF_ERROR(CheckPreparingOptions(options.preparing));
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options.thinning));
  BCCSKEL_RETURN_IF_ERROR(CheckPruningOptions(options.pruning));
  BCCSKEL_RETURN_IF_ERROR(CheckJunctionReach(options.junction_reach));
  for (const int32_t slabs : options.voxel_slabs) {
    if (slabs >= 1 && slabs <= 8) continue;
    return absl::InvalidArgumentError(
        absl::StrFormat("%d slabs of a voxel: must be 1 to 8", slabs));
  }
  if (options.thinning.kind == SkeletonKind::kSurface && !IsForSheets(options.pruning.rule)) {
    return absl::InvalidArgumentError(
        "pruning by length, relative length or persistence: is for curves; the kind surface is "
        "pruned by the default rule, the thickness of its sheets, or by none");
  }
  if (options.pruning.rule == PruningRule::kPersistence &&
      options.thinning.kind != SkeletonKind::kIsthmusCurve) {
    return absl::InvalidArgumentError(
        "pruning by persistence: needs the kind isthmus-curve, which knows when each point became "
        "an isthmus");
  }
  return absl::OkStatus();
}

}  // namespace bccskel
