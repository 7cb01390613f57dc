#ifndef BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_
#define BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_

#include <span>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/thin_skeleton.h"

namespace bccskel {

// Lattice units, where the surface was sampled point by point.
inline constexpr double kDefaultSheetMargin = 4;

// Does:  removes points that are worth less than the margin (sheet_burning.h), as they burn; then
//        curves that end and whose balls leave that of the place where they begin by less than the
//        margin, the way counted half; then points that have become simple and are neither
//        isthmuses nor ends, as thinning would.
// Why it is right: each point is simple at its turn. Points of `keep` stay.
// Needs: a surface skeleton with the births of its isthmuses.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ThinSkeleton> PruneSheets(const ThinSkeleton& sheets, double margin,
                                         std::span<const LatticePoint> keep,
                                         const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SHEET_PRUNER_H_
