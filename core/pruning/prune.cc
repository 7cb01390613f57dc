#include "core/pruning/prune.h"

#include "absl/strings/str_format.h"
#include "core/distance/exact_radius.h"
#include "core/pruning/branch_pruner.h"
#include "core/pruning/pruning_levels.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"

namespace bccskel {
namespace {

constexpr double kDefaultSlopeMargin = 4;
constexpr double kDefaultRelativeLength = 1;

// In the rule's own unit.
double ThresholdOf(const PruningOptions& options, const Placement& placement) {
  if (options.rule == PruningRule::kLength) {
    return options.threshold / WorldUnitsPerLatticeUnit(placement);
  }
  if (options.threshold != 0) return options.threshold;
  return options.rule == PruningRule::kSlope ? kDefaultSlopeMargin : kDefaultRelativeLength;
}

}  // namespace

PruningOptions ForSteps(const PruningOptions& options, double step) {
  PruningOptions stepped = options;
  const bool is_default = options.rule == PruningRule::kSlope && options.threshold == 0;
  if (is_default && step > 1) stepped.threshold = kDefaultSlopeMargin * step;
  return stepped;
}

absl::Status CheckPruningOptions(const PruningOptions& options) {
  if (!(options.threshold >= 0 && options.threshold <= 1e9)) {
    return absl::InvalidArgumentError(absl::StrFormat(
        "pruning threshold %g: must be 0 (the rule's default) to 1e9", options.threshold));
  }
  if (options.rule == PruningRule::kLength && options.threshold == 0) {
    return absl::InvalidArgumentError(
        "pruning by length: needs a threshold above 0, the length in world units");
  }
  return absl::OkStatus();
}

absl::StatusOr<PrunedSkeleton> Prune(const Volume& thin, std::span<const float> radii,
                                     const Volume& object, const DistanceField& field,
                                     std::span<const LatticePoint> keep,
                                     const PruningOptions& options, const exec::Context& context) {
  if (absl::Status checked = CheckPruningOptions(options); !checked.ok()) return checked;
  if (thin.empty()) return PrunedSkeleton{thin, {}, 0, {}};
  ThinSet set(thin, radii);
  const PointSet kept(keep.begin(), keep.end());
  PrunedSkeleton pruned;
  if (options.rule != PruningRule::kNone) {
    const double threshold = ThresholdOf(options, thin.placement());
    pruned.branches_removed = BranchPruner(set, options.rule, threshold, kept, context).Run();
  }
  pruned.levels = PruningLevelsOf(set, kept, context);
  if (options.tips == TipPlacement::kRidge) {
    ExactRadius radius(object, field);
    PlaceTips(set, radius, object, kept, context);
  }
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  pruned.thin = set.ToVolume(thin);
  pruned.radii = set.RadiiOf(pruned.thin);
  return pruned;
}

}  // namespace bccskel
