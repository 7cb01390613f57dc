#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize_within.h"

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

int32_t CellsPerVoxel(ObjectSource source) {
  return source == ObjectSource::kRefinedVoxels ? 2 : 1;
}

bool IsConverted(ObjectSource source) {
  return source == ObjectSource::kVoxels || source == ObjectSource::kRefinedVoxels;
}

std::optional<size_t> AxisOfOneSlice(const LatticeExtent& extent,
                                     const SkeletonizeOptions& options) {
  if (options.source == ObjectSource::kPoints) return std::nullopt;
  const bool sampled = options.source == ObjectSource::kSampledVoxels;
  const int32_t refinement = CellsPerVoxel(options.source);
  const std::array<int32_t, 3> cells = {extent.nx, extent.ny, extent.nz};
  std::optional<size_t> axis;
  for (size_t n = 0; n < 3; ++n) {
    if (cells[n] != (sampled ? 1 : options.voxel_slabs[n] * refinement + 1)) continue;
    if (axis.has_value()) return std::nullopt;
    axis = n;
  }
  return axis;
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
        "pruning by length, relative length or persistence: applies to curves; the kind surface is "
        "pruned by the default rule, the thickness of its sheets, or not at all");
  }
  if (options.pruning.rule == PruningRule::kPersistence &&
      options.thinning.kind != SkeletonKind::kIsthmusCurve) {
    return absl::InvalidArgumentError(
        "pruning by persistence: needs the kind isthmus-curve, which records when each point "
        "became an isthmus");
  }
  return absl::OkStatus();
}

}  // namespace bccskel
