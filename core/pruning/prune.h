#ifndef BCCSKEL_CORE_PRUNING_PRUNE_H_
#define BCCSKEL_CORE_PRUNING_PRUNE_H_

#include <cstdint>
#include <optional>
#include <span>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/distance/exact_radius.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/prepare/border_cuts.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/volume/volume.h"

namespace bccskel {

// Decides which branches, from an end to the first junction, are spurious.
enum class PruningRule : uint8_t {
  // Branches that stick out by less than the threshold, 0.45 by default, in half-widths of the
  // object beside them: bumps, ribs of flat parts, and strands beside another strand. See
  // significance.h. Of an object without limbs, such as a cube, only the deepest point stays.
  kSignificance,
  // Branches shorter than the threshold, in world units.
  kLength,
  // Branches shorter than threshold * R, where R is the largest radius at the junction and the
  // threshold is 1 by default.
  kRelativeLength,
  // Branches with a persistence below the threshold, 6 by default (persistence.h). Needs the births
  // of isthmuses.
  kPersistence,
  kNone,
};

// Default threshold of kSignificance, in half-widths.
inline constexpr double kDefaultSignificance = 0.45;
inline constexpr double kMaxPruningThreshold = 1e9;  // of any rule

// Whether tips are moved to the end of the ridge of the distances.
enum class TipPlacement : uint8_t { kRidge, kAsThinned };

struct PruningOptions {
  PruningRule rule = PruningRule::kSignificance;
  double threshold = 0;  // 0: the rule's default; a length must be given
  TipPlacement tips = TipPlacement::kRidge;

  friend bool operator==(const PruningOptions&, const PruningOptions&) = default;
};

// Returns the options with a threshold of 0 replaced by the rule's default; without a rule the
// threshold becomes 0.
PruningOptions WithDefaults(PruningOptions options);

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckPruningOptions(const PruningOptions& options);

// The object that pruning measures.
struct PrunedObject {
  const Volume& object;
  const ExactRadius& radius;  // of the object
  // In lattice units: 1 where the object's surface was sampled point by point, otherwise the edge
  // of a voxel.
  double surface_step = 1;
  // Into how many slabs each voxel was cut along x, y and z.
  std::array<int32_t, 3> slabs = {1, 1, 1};
  // The object in its window; null: `object`. Depths are measured here. Widths across branches are
  // measured in `object`, so that they end where the object is cut off: otherwise a thin stack
  // would seem wide beyond its faces.
  const Volume* space = nullptr;
  // The box of the outermost points of the image whose border cuts limbs off; none: no image does.
  std::optional<LatticeBox> image = std::nullopt;
  const BorderCuts* cuts = nullptr;  // their middles are points to keep; null: none

  const Volume& WhereDepthsAre() const { return space != nullptr ? *space : object; }
};

// Removes spurious branches and places the tips of the others. Points are removed and added one by
// one, each simple at its turn, so the topology stays: loops and components have no end to begin
// at. Branches with points of `keep` stay. Levels are those of the skeleton as pruned, before tips
// are placed. Isthmuses that later became simple make curves thick; where births are known, such
// points are removed first.
// Shapes: the points of `curves` are points of the object.
// Needs:  a thin curve skeleton, or one of isthmuses with their births.
// Errors: INVALID_ARGUMENT (options, or persistence without births), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ThinSkeleton> Prune(const ThinSkeleton& curves, const PrunedObject& in,
                                   std::span<const LatticePoint> keep,
                                   const PruningOptions& options, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNE_H_
