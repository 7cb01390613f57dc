#include "core/pruning/prune.h"

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <utility>

#include "absl/strings/str_format.h"
#include "core/exec/status_macros.h"
#include "core/exec/stop_poll.h"
#include "core/pruning/branch_pruner.h"
#include "core/pruning/grow_body_ends.h"
#include "core/pruning/grow_missed_limbs.h"
#include "core/pruning/simple_points.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"
#include "core/pruning/turned_tips.h"

namespace bccskel {
namespace {

constexpr double kDefaultRelativeLength = 1;
constexpr double kDefaultPersistence = 6;

double DefaultOf(PruningRule rule) {
  switch (rule) {
    case PruningRule::kSignificance:
      return kDefaultSignificance;
    case PruningRule::kRelativeLength:
      return kDefaultRelativeLength;
    case PruningRule::kPersistence:
      return kDefaultPersistence;
    case PruningRule::kLength:  // must be given
    case PruningRule::kNone:
      return 0;
  }
  return 0;
}

// In the unit of the rule.
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

// The path's deepest point; of several, the one nearest to its middle.
size_t DeepestOf(const ThinSet& set, const std::vector<LatticePoint>& path) {
  const auto rank = [&](size_t n) {
    const auto off = std::abs(2 * static_cast<int64_t>(n) + 1 - static_cast<int64_t>(path.size()));
    return std::pair(-set.RadiusOf(path[n]), off);
  };
  size_t deepest = 0;
  for (size_t n = 1; n < path.size(); ++n) {
    if (rank(n) < rank(deepest)) deepest = n;
  }
  return deepest;
}

// Whether a half of the path, from position `deepest`, is a limb, however thick what it leaves.
bool HasLimb(const ThinSet& set, const std::vector<LatticePoint>& path, size_t deepest,
             double threshold, Significance& significance) {
  const auto middle = path.begin() + static_cast<std::ptrdiff_t>(deepest);
  const std::array<FreeBranch, 2> halves = {
      {{{path.begin(), middle}, *middle},
       {{path.rbegin(), std::reverse_iterator(middle + 1)}, *middle}}};
  return std::ranges::any_of(halves, [&](const FreeBranch& half) {
    return !half.points.empty() && significance.Of(set, half) >= threshold;
  });
}

// The curve of an object without limbs depends on the pose: a cube has four equal diagonals. So a
// path whose halves do not stick out of its deepest ball, and have no limb that does, shrinks to
// that ball's center.
void CollapsePaths(ThinSet& set, Significance& significance, double threshold, const PointSet& keep,
                   const exec::Context& context) {
  constexpr double kMost = 0.25;  // a spheroid 1.3 times as long as thick has it
  for (const LatticePoint end : set.Ends()) {
    if (context.ShouldStop()) return;
    if (!set.Contains(end) || !set.IsEnd(end)) continue;
    const FreeBranch branch = BranchFrom(set, end);
    const std::vector<LatticePoint>& path = branch.points;
    const bool kept = std::ranges::any_of(path, [&](LatticePoint p) { return keep.contains(p); });
    if (branch.junction.has_value() || kept) continue;
    const size_t deepest = DeepestOf(set, path);
    std::array<BranchPath, 2> halves;
    for (size_t n = deepest; n < path.size(); ++n) halves[0].points.push_back(path[n]);
    for (size_t n = deepest + 1; n-- > 0;) halves[1].points.push_back(path[n]);
    for (BranchPath& half : halves) {
      for (const LatticePoint p : half.points) half.radii.push_back(set.RadiusOf(p));
    }
    if (significance.OfPath(set, std::move(halves)) >= std::min(threshold, kMost)) continue;
    if (HasLimb(set, path, deepest, threshold, significance)) continue;
    for (size_t n = 0; n < deepest; ++n) set.Remove(path[n]);
    for (size_t n = path.size() - 1; n > deepest; --n) set.Remove(path[n]);
  }
}

void SetLevels(const PruningLevels& levels, double least, ThinSkeleton& skeleton) {
  skeleton.levels.reserve(skeleton.radii.size());
  skeleton.points.ForEachPoint([&](LatticePoint p) {
    const double* level = levels.Find(p);
    skeleton.levels.push_back(level != nullptr ? std::max(*level, least) : kNoLevel);
  });
}

Significance SignificanceIn(const Volume& space, const ExactRadius& radius, const PrunedObject& in,
                            const SurfaceNoise& noise) {
  std::optional<FirmDepth> firm_depth;
  // A voxel's pit is a voxel deep.
  if (in.surface_step != 1 && noise.roughness > 0) firm_depth.emplace(space, radius);
  return Significance(in.object, noise, TipExtender(space, radius, in.surface_step),
                      std::move(firm_depth), space.window(), in.cuts);
}

}  // namespace

PruningOptions WithDefaults(PruningOptions options) {
  if (options.threshold == 0 || options.rule == PruningRule::kNone) {
    options.threshold = DefaultOf(options.rule);
  }
  return options;
}

absl::Status CheckPruningOptions(const PruningOptions& options) {
  if (!(options.threshold >= 0 && options.threshold <= kMaxPruningThreshold)) {
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
  const Volume& space = in.WhereDepthsAre();
  const SurfaceNoise noise = SurfaceNoiseOf(in.object, in.surface_step, in.slabs, context);
  const ExactRadius in_space = &space == &in.object ? in.radius : ExactRadius(space);
  Significance significance = SignificanceIn(space, in_space, in, noise);
  std::optional<TipDepths> depths;  // none if no tips are placed
  if (options.tips == TipPlacement::kRidge) depths.emplace(space, in.radius);
  TurnedTips turned;
  const PruningRule rule_of_levels = RuleOfLevels(options, curves);
  double least_level = 0;  // ends of bodies stay by measures of their own
  if (options.rule != PruningRule::kNone) {
    const double threshold = ThresholdOf(options, curves.points.placement());
    if (options.rule == rule_of_levels) least_level = threshold;
    const bool by_shape = options.rule == PruningRule::kSignificance;
    BranchPruner(set, significance, options.rule, threshold, kept, context)
        .Run([](LatticePoint, double) {}, by_shape ? &turned : nullptr);
    turned.DropFrom(threshold);
    if (by_shape) {
      CollapsePaths(set, significance, threshold, kept, context);
      if (depths.has_value()) {
        const double least = std::max(threshold, kDefaultSignificance);
        GrowBodyEnds(set, in, *depths, significance, least, context);
        GrowMissedLimbs(set, in, *depths, noise, significance, least, context);
      }
    }
    if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  }
  PruningLevels levels;
  ThinSet before_tips = set;
  exec::Context alone = context;
  alone.team = nullptr;  // which places tips
  const auto find_levels = [&] {
    levels = PruningLevelsOf(std::move(before_tips), significance, rule_of_levels, kept, alone);
  };
  PointSet stay = kept;
  if (in.cuts != nullptr) stay.insert(in.cuts->middles.begin(), in.cuts->middles.end());
  absl::StatusOr<PointsByAxis> at_border = PointsByAxis();
  if (depths.has_value()) {
    at_border = PlaceTips(set, in, *depths, stay, noise, turned, context, find_levels);
  } else {
    find_levels();
  }
  if (!at_border.ok()) return at_border.status();
  if (absl::Status stop = context.StopStatus(); !stop.ok()) return stop;
  ThinSkeleton pruned = set.ToSkeleton(curves);
  pruned.at_border = *std::move(at_border);
  SetLevels(levels, least_level, pruned);
  return pruned;
}

}  // namespace bccskel
