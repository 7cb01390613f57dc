#ifndef BCCSKEL_CORE_RANKS_RANK_SHELLS_H_
#define BCCSKEL_CORE_RANKS_RANK_SHELLS_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/ranks/exchange.h"
#include "core/ranks/rank_bricks.h"
#include "core/shells/shells.h"

namespace bccskel::ranks {

// The shells of all bricks of RankBricks::local, including ghosts.
struct RankShells {
  Shells shells;       // last() is the object's
  BrickDepths depths;  // empty if not wanted
};

// Does:  BuildShells() and BuildDepths() for a distributed object; the same bits.
// Why it is right: bricks are sent to ranks that own whole layers, with the layers below and above.
//   Euclidean distances within layers need only whole layers, those across layers only whole
//   columns (euclidean_scan.cc), so squares are sent to ranks that own whole columns. Chamfer scans
//   go up and down and need only the adjacent layer (chamfer_scan.cc), so ranks scan one after the
//   other. Shells are sent to the owners.
// Cost:  Euclidean distances are measured some columns at a time. Besides the shells, a rank holds
//        76 bytes for each brick of its layers and the two adjacent ones, and the squares of a
//        round, which are sent in pieces. Sent per brick: 72 to 216 bytes to the layers, 1,088
//        squares to the columns, 400 or 720 bytes back. Chamfer scans take as long as on one
//        machine, and the memory of StreamShells() for a rank's layers.
// Errors: CANCELLED, DEADLINE_EXCEEDED, on all ranks.
absl::StatusOr<RankShells> MeasureShells(Exchange& exchange, const RankBricks& bricks,
                                         DistanceKind kind, double shell_width, Depths depths,
                                         const exec::Context& context);

}  // namespace bccskel::ranks

#endif  // BCCSKEL_CORE_RANKS_RANK_SHELLS_H_
