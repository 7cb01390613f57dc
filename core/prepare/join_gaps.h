#ifndef BCCSKEL_CORE_PREPARE_JOIN_GAPS_H_
#define BCCSKEL_CORE_PREPARE_JOIN_GAPS_H_

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// In lattice units; what is farther apart is no gap of a segmentation.
inline constexpr double kMaxGap = 256;

// Does:  joins components at most `gap` lattice units apart, each pair by a bridge one point thick:
//        the shortest bridges first, and only between components that are not joined yet (a
//        minimum spanning forest). So no loops arise except where a bridge runs along a surface.
// Where two components are nearest is found by growing all at the same rate until they meet, except
// the largest (of several, the one with the first point) and what is joined to it.
// Cost:  for each background point that components reach before they are joined, at most within
//        `gap` of them, the logarithm of the number of such points.
// Errors: of the budget; CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> JoinGaps(const Volume& object, double gap, exec::MemoryBudget& memory,
                                       const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_JOIN_GAPS_H_
