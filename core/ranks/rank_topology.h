#ifndef BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_
#define BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/ranks/exchange.h"
#include "core/ranks/rank_bricks.h"

namespace bccskel::ranks {

// Does:  CountBettiNumbers() for a distributed object. Only the numbers on rank 0 are valid.
// Why it is right: a rank labels whole layers and the layer above, which is the lowest of the next
//   rank, and nothing beyond. So any two pieces that touch are joined on some rank, and the
//   object's components are those of the ranks, united where two ranks have labeled the same piece.
//   The points of a clique lie in one layer or two adjacent ones, so Euler characteristics add up
//   after those of the shared layers are subtracted.
// Cost:  as on one machine for the bricks of a rank's layers and one more; sends 72 to 144 bytes
//        per brick, 8 per piece of a shared layer, and to rank 0 32 per pair of components that are
//        united.
// Errors: CANCELLED, DEADLINE_EXCEEDED, on all ranks.
absl::StatusOr<BettiNumbers> CountBettiNumbersOverRanks(Exchange& exchange,
                                                        const RankBricks& bricks,
                                                        const exec::Context& context);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_TOPOLOGY_H_
