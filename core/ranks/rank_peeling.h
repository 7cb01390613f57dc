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

// Does:  ThinObject() by all ranks together, and CountBettiNumbers() of the object; the same bits
//        for any number of ranks, and of threads on each.
// Needs: each brick of the object is in the part of one rank, in any order; all have the same
//        options, extent and placement.
// Returns: the result on rank 0, nothing but an empty one elsewhere. There the whole object takes
//        the place of the part, and nothing elsewhere.
// Cost:  a rank owns its share of the bricks (rank_bricks.h). Per pass one Trade() with those who
//        have bricks beside its own, 68 bytes for each brick on the border that loses points; per
//        shell one Sum().
// Errors: INVALID_ARGUMENT, where two ranks have the same brick, too; those of Checkpoints;
// CANCELLED and DEADLINE_EXCEEDED on all ranks where one has to stop.
absl::StatusOr<PeeledObject> PeelOverRanks(Exchange& exchange, Volume& part, DistanceKind distance,
                                           const ThinningOptions& options,
                                           const CheckpointOptions& checkpoints,
                                           const exec::Context& context);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_PEELING_H_
