#ifndef BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_
#define BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>

#include "core/exec/memory_budget.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Memory for each point that thinning leaves, from pruning to the graph. Tracing needs most of it:
// measured, with at most kEdgePointsPerPoint points on edges for each, 330 bytes for isolated
// points and 400 for nets. The number of points depends on the object: a brick of dust leaves 256,
// a solid brick at most one.
inline constexpr uint64_t kBytesPerThinPoint = 576;

// Whether the object is the exact conversion of a mask.
bool IsConverted(ObjectSource source);

// The axis along which the mask of an object has a single slice, as for a 2-D image. Along this
// axis the object continues beyond both faces, regardless of SkeletonizeOptions::border, since only
// its shape within the slice matters. No value for masks of one row, for objects that are not
// masks, and for samplings with several cells per voxel, where the lattice does not show it.
std::optional<size_t> AxisOfOneSlice(const LatticeExtent& extent,
                                     const SkeletonizeOptions& options);

// Skeletonize() within a budget. The caller has reserved the memory that follows from the object's
// bricks; the pipeline reserves kBytesPerThinPoint before it prunes, and the needs of
// TraceSkeleton(). All of it stays reserved, also for the result.
// Errors: as Skeletonize(); the budget's.
absl::StatusOr<SkeletonizeResult> SkeletonizeWithin(exec::MemoryBudget& memory,
                                                    const Volume& object,
                                                    const SkeletonizeOptions& options,
                                                    const exec::Context& context,
                                                    const OnShellPoints& on_points = nullptr);

// An object that a Peeler has thinned.
struct PeeledObject {
  ThinningResult thinned;  // as from ThinObject()
  BettiNumbers topology;   // of the object
  uint64_t points = 0;
};

// Replaces ThinObject() and, for the object, CountBettiNumbers(). On entry `object` may be a part
// of the object; on return it is the whole.
using Peeler =
    std::function<absl::StatusOr<PeeledObject>(Volume& object, const ThinningOptions& options)>;

// Skeletonize() with a peeler, which may hold most of the object: the same result as with
// Border::kEnds. This process
// prunes, computes the certificate of the result and traces the graph, all for the whole object.
// Preparing needs the whole object from the beginning.
// Errors: as Skeletonize(); those of the peeler; INVALID_ARGUMENT for objects that continue beyond
//         their border, as masks of one slice do.
absl::StatusOr<SkeletonizeResult> SkeletonizeBy(const Peeler& peeler, Volume& object,
                                                const SkeletonizeOptions& options,
                                                const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_
