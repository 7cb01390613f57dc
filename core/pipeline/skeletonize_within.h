#ifndef BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_
#define BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_

#include <cstdint>
#include <functional>

#include "core/exec/memory_budget.h"
#include "core/pipeline/skeletonize.h"

namespace bccskel {

// Memory for each point that thinning leaves, from pruning to the graph; see kTraceBytesPerPoint.
// It follows what the object looks like: a brick of dust leaves 256 points, one of a solid none or
// one.
inline constexpr uint64_t kBytesPerThinPoint = 576;

// Skeletonize() in a budget. The caller has taken what follows the bricks of the object; the
// pipeline takes kBytesPerThinPoint before it prunes, and what TraceSkeleton() asks for. All that
// was taken stays taken, also for the result.
// Errors: as Skeletonize(); the budget's.
absl::StatusOr<SkeletonizeResult> SkeletonizeWithin(exec::MemoryBudget& memory,
                                                    const Volume& object,
                                                    const SkeletonizeOptions& options,
                                                    const exec::Context& context,
                                                    const OnShellPoints& on_points = nullptr);

// An object and what others made of it.
struct PeeledObject {
  ThinningResult thinned;  // as of ThinToCurve()
  BettiNumbers topology;   // of the object
  uint64_t points = 0;
};

// Thins in place of ThinToCurve(), and counts the topology of the object in place of
// CountBettiNumbers(). `object` may be a part of the object, and is the whole afterwards.
using Peeler =
    std::function<absl::StatusOr<PeeledObject>(Volume& object, const ThinningOptions& options)>;

// Skeletonize() where others peel the object, which they may have most of: the same result.
// Pruning, the certificate of the result and the graph are made here, of the whole object.
// Preparing needs a whole one from the beginning. Errors: as Skeletonize(); the peeler's;
// INVALID_ARGUMENT for objects that continue beyond their
//         border.
absl::StatusOr<SkeletonizeResult> SkeletonizeBy(const Peeler& peeler, Volume& object,
                                                const SkeletonizeOptions& options,
                                                const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_SKELETONIZE_WITHIN_H_
