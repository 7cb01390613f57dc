#ifndef BCCSKEL_CORE_RANKS_RANK_PEELING_H_
#define BCCSKEL_CORE_RANKS_RANK_PEELING_H_

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/pipeline/skeletonize_within.h"
#include "core/ranks/checkpoints.h"
#include "core/ranks/exchange.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel::ranks {

// Does:  runs ThinObject() and, for the object, CountBettiNumbers() on all ranks together; the same
//        bits for any number of ranks, and of threads on each.
// Needs: each brick of the object is in the part of one rank, in any order; all have the same
//        options, extent and placement.
// Returns: on rank 0 the result, and `part` becomes the whole object; on other ranks both are
//          empty.
// Cost:  a rank owns its share of the bricks (rank_bricks.h). Per pass one Trade() with the ranks
//        that have adjacent bricks, 68 bytes for each border brick that loses points; per shell one
//        Sum().
// Errors: INVALID_ARGUMENT, also if two ranks have the same brick; those of Checkpoints; CANCELLED
//         and DEADLINE_EXCEEDED, on all ranks if one must stop.
absl::StatusOr<PeeledObject> PeelOverRanks(Exchange& exchange, Volume& part, DistanceKind distance,
                                           const ThinningOptions& options,
                                           const CheckpointOptions& checkpoints,
                                           const exec::Context& context);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_PEELING_H_
