#ifndef BCCSKEL_CORE_PRUNING_PRUNE_H_
#define BCCSKEL_CORE_PRUNING_PRUNE_H_

#include <cstdint>
#include <span>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/volume/volume.h"

namespace bccskel {

// Which branches, from an end to the first junction, are spurious.
enum class PruningRule : uint8_t {
  // Those that stick out by less than the threshold, 0.45 by default, in half-widths of the object
  // beside them: bumps, ribs of flat parts, and strands beside another one. See significance.h.
  // What then is left of an object without limbs, such as a cube, is its deepest point.
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
inline constexpr double kDefaultSignificance = 0.45;

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

// Where pruning measures.
struct PrunedObject {
  const Volume& object;
  const ExactRadius& radius;  // of the object
  // Lattice units: 1 where the object's surface was sampled point by point, else a voxel's edge.
  double surface_step = 1;
  // That voxels were cut into along x, y and z.
  std::array<int32_t, 3> slabs = {1, 1, 1};
  // Where depths are measured, if not in the object: the same in a window. Widths across branches
  // end where the object is cut off: beyond, all of a thin stack would be as wide as it is not
  // high.
  const Volume* space = nullptr;
};

// Removes spurious branches and places the tips of the others. Points go and come one by one, each
// simple at its turn, so the topology stays: loops and components have no end to begin at. A branch
// with points of `keep` stays. Levels are those of the skeleton as pruned, before tips were placed.
// Isthmuses that later became simple make curves thick: where births are known, such points go
// first.
// Shapes: the points of `curves` are points of the object.
// Needs:  a thin curve skeleton, or one of isthmuses with their births.
// Errors: INVALID_ARGUMENT (options, or persistence without births), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ThinSkeleton> Prune(const ThinSkeleton& curves, const PrunedObject& in,
                                   std::span<const LatticePoint> keep,
                                   const PruningOptions& options, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNE_H_
