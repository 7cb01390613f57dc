#ifndef BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_
#define BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_

#include <span>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/thin_skeleton.h"

namespace bccskel {

// Lattice units, for surfaces sampled point by point.
inline constexpr double kDefaultSheetMargin = 4;

// Does:  removes points with a value below the margin (sheet_burning.h) in the order in which they
//        burn. Then removes curves that end and whose balls extend beyond the ball where they begin
//        by less than the margin, with distances counted half. Then removes points that have become
//        simple and are neither isthmuses nor ends, as thinning would.
// Why it is right: each point is simple at its turn. Points of `keep` stay.
// Needs: a surface skeleton with the births of its isthmuses.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ThinSkeleton> PruneSheets(const ThinSkeleton& sheets, double margin,
                                         std::span<const LatticePoint> keep,
                                         const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_
