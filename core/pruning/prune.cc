#include "core/pruning/prune.h"

#include <functional>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/branch_pruner.h"
#include "core/pruning/pruning_defaults.h"
#include "core/pruning/pruning_levels.h"
#include "core/pruning/simple_points.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"

namespace bccskel {
namespace {

// In the rule's own unit.
double ThresholdOf(const PruningOptions& options, const Placement& placement) {
  const double threshold = WithDefaults(options).threshold;
  const bool in_world = options.rule == PruningRule::kLength;
  return in_world ? threshold / WorldUnitsPerLatticeUnit(placement) : threshold;
}

PruningRule RuleOfLevels(const PruningOptions& options, const ThinSkeleton& curves) {
  const bool by_births = options.rule == PruningRule::kNone && !curves.births.empty();
  return by_births || options.rule == PruningRule::kPersistence ? PruningRule::kPersistence
                                                                : PruningRule::kSignificance;
}

absl::Status CheckCurves(const ThinSkeleton& curves, const PruningOptions& options) {
  if (options.rule != PruningRule::kPersistence || !curves.births.empty() ||
      curves.points.empty()) {
    return absl::OkStatus();
  }
  return absl::InvalidArgumentError(
      "pruning by persistence: needs to know when each point became an isthmus");
}

// Levels and tips need nothing of each other: on two workers, if there are as many.
void RunBoth(const std::function<void(const exec::Context&)>& first,
             const std::function<void(const exec::Context&)>& second, int workers,
             const exec::Context& context) {
  if (workers == 1) {
    first(context);
    second(context);
    return;
  }
  exec::Context alone = context;
  alone.team = nullptr;
  exec::Portions parts(2, 1);
  context.Offer(2, [&](int) {
    for (exec::Share mine = parts.Take(); mine.begin < mine.end; mine = parts.Take()) {
      (mine.begin == 0 ? first : second)(alone);
    }
  });
}

}  // namespace

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

absl::StatusOr<ThinSkeleton> Prune(const ThinSkeleton& curves, const PrunedObject& in,
                                   std::span<const LatticePoint> keep,
                                   const PruningOptions& options, const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckPruningOptions(options));
  BCCSKEL_RETURN_IF_ERROR(CheckCurves(curves, options));
  if (curves.points.empty()) return curves;
  ThinSet set(curves, context);
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  const PointSet kept(keep.begin(), keep.end());
  if (!curves.births.empty()) {
    StopPoll poll(context);
    RemoveSimplePoints(set, kept, poll);
  }
  const Volume& space = in.space != nullptr ? *in.space : in.object;
  const SurfaceNoise noise = SurfaceNoiseOf(in.object, in.surface_step, in.slabs);
  const ExactRadius in_space = in.space == nullptr ? in.radius : ExactRadius(space);
  std::optional<WayOn> way_on;
  std::optional<FirmDepth> firm_depth;
  // A voxel's edge is longer than what thinning leaves out, and its pit is deeper than a point's.
  if (in.surface_step == 1) {
    way_on.emplace(space, in_space);
  } else if (noise.roughness > 0) {
    firm_depth.emplace(space, in_space);
  }
  Significance significance(in.object, noise, std::move(way_on), std::move(firm_depth));
  if (options.rule != PruningRule::kNone) {
    const double threshold = ThresholdOf(options, curves.points.placement());
    BranchPruner(set, significance, options.rule, threshold, kept, context).Run();
    if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  }
  PruningLevels levels;
  ThinSet before_tips = set;
  const auto find_levels = [&](const exec::Context& own) {
    levels = PruningLevelsOf(std::move(before_tips), significance, RuleOfLevels(options, curves),
                             kept, own);
  };
  absl::Status placed;
  const auto place_tips = [&](const exec::Context& own) {
    if (options.tips != TipPlacement::kRidge) return;
    placed = PlaceTips(set, in.object, space, in.radius, kept, noise, own);
  };
  RunBoth(find_levels, place_tips, context.WorkersFor(set.Ends().size(), Significance::kWork),
          context);
  if (!placed.ok()) return placed;
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  ThinSkeleton pruned = set.ToSkeleton(curves);
  pruned.levels.reserve(pruned.radii.size());
  pruned.points.ForEachPoint([&](LatticePoint p) {
    const double* level = levels.Find(p);
    pruned.levels.push_back(level != nullptr ? *level : kNoLevel);
  });
  return pruned;
}

}  // namespace bccskel
