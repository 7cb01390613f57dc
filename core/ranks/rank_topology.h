#ifndef BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_
#define BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/ranks/exchange.h"
#include "core/ranks/rank_bricks.h"

namespace bccskel::ranks {

// Does:  CountBettiNumbers() of an object that is spread over ranks. On rank 0; elsewhere the
//        numbers mean nothing.
// Why it is right: a rank labels whole layers and the one above, which is the lowest of the next
//        rank, and links nothing beyond. So every two pieces that touch are linked on some rank,
//        and the components of all are those of the ranks, glued where two have labeled the same
//        piece. The points of a clique lie in one layer or two that follow each other, so Euler
//        numbers add up when those of the shared layers are taken off.
// Cost:  as on one machine for the bricks of a rank's layers and one more; on the wire 72 to 144
//        bytes for each brick, 8 for each piece of a shared layer, 32 on rank 0 for each pair of
//        components that are glued.
// Errors: CANCELLED, DEADLINE_EXCEEDED, on all ranks.
absl::StatusOr<BettiNumbers> CountBettiNumbersOverRanks(Exchange& exchange,
                                                        const RankBricks& bricks,
                                                        const exec::Context& context);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_
