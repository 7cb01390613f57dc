#ifndef BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_
#define BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_

#include "core/exec/context.h"
#include "core/pruning/point_table.h"
#include "core/pruning/prune.h"
#include "core/pruning/significance.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/tips.h"

namespace bccskel {

// For each point of a branch, the threshold above which it goes; infinity where it never does.
// Points at junctions have none.
using PruningLevels = PointTable<double>;

// Does:  answers every threshold of a rule in one run: pruning by a threshold leaves the
//        points whose level is not below it. Branches go one after the other, the least first; the
//        level of a branch is the most that it or a branch before it was worth, 0 at least.
// Why it is right: the rule takes the least first, so pruning by a threshold is the first part of
//        this run, up to where all branches left are worth the threshold or more.
// Errors: none; what is left when the context says stop stays at infinity.
PruningLevels PruningLevelsOf(ThinSet set, Significance& significance, PruningRule rule,
                              const PointSet& keep, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_PRUNING_LEVELS_H_
