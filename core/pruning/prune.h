#ifndef BCCSKEL_CORE_PRUNING_PRUNE_H_
#define BCCSKEL_CORE_PRUNING_PRUNE_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/pruning/thin_set.h"
#include "core/volume/volume.h"

namespace bccskel {

// Which branches, from an end to the first junction, are spurious.
enum class PruningRule : uint8_t {
  // Those that stick out by less than the threshold, 0.47 by default, in half-widths of the object
  // beside them: bumps, ribs of flat parts, and strands beside another one. See significance.h.
  kSignificance,
  // Those shorter than the threshold, in world units.
  kLength,
  // Those shorter than threshold * R; R is the largest radius of the junction, the factor 1 by
  // default.
  kRelativeLength,
  // Those of a persistence below the threshold: see persistence.h. Needs the births of isthmuses.
  kPersistence,
  kNone,
};

// Of the rule of significance, half-widths.
inline constexpr double kDefaultSignificance = 0.47;

// Whether ends are moved along the ridge of the distances to where it ends.
enum class TipPlacement : uint8_t { kRidge, kAsThinned };

struct PruningOptions {
  PruningRule rule = PruningRule::kSignificance;
  double threshold = 0;  // 0: the rule's default; a length must be given
  TipPlacement tips = TipPlacement::kRidge;

  friend bool operator==(const PruningOptions&, const PruningOptions&) = default;
};

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckPruningOptions(const PruningOptions& options);

// For each point of a branch, the threshold above which it goes; infinity where it never does.
// Points at junctions and tips that have grown have none. Thresholds are those of pruning by
// persistence where that was the rule, or none was and births are known; else those of
// significance.
using PruningLevels = PointTable<double>;

struct PrunedSkeleton {
  Volume thin;
  std::vector<float> radii;  // of its points, lattice units, in the order of ForEachPoint()
  uint64_t branches_removed = 0;
  PruningLevels levels;  // as pruned, before tips were placed
};

// Removes spurious branches and places the tips of the others. Points go and come one by one, each
// simple at its turn, so the topology stays: loops and components have no end to begin at. A branch
// with points of `keep` stays.
// Isthmuses that later became simple make curves thick: where births are known, such points go
// first.
// Shapes: the points of `curves` are points of `object`, to which `radius` belongs.
// Needs:  a thin curve skeleton, or one of isthmuses with their births.
// Errors: INVALID_ARGUMENT (options, or persistence without births), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<PrunedSkeleton> Prune(const ThinCurves& curves, const Volume& object,
                                     const ExactRadius& radius, std::span<const LatticePoint> keep,
                                     const PruningOptions& options, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNE_H_
