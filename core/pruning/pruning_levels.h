#ifndef BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_
#define BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_

#include "core/exec/context.h"
#include "core/pruning/point_table.h"
#include "core/pruning/prune.h"
#include "core/pruning/significance.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"

namespace bccskel {

// The level of each point of a branch: the threshold above which the point is removed; infinity if
// it is never removed. Points at junctions have none.
using PruningLevels = PointTable<double>;

// Does:  answers every threshold of a rule in one run: pruning by a threshold leaves the points
//        whose level is not below it. Branches are removed one by one, the smallest value first.
//        The level of a branch is the largest value of all branches up to and including it, at
//        least 0.
// Why it is right: the rule removes the smallest value first, so pruning by a threshold is the
//   first part of this run, until all remaining branches reach the threshold.
// Errors: none; points that remain when the context requests a stop keep the level infinity.
PruningLevels PruningLevelsOf(ThinSet set, Significance& significance, PruningRule rule,
                              const PointSet& keep, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_
