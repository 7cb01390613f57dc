#include "core/pruning/pruning_levels.h"

#include <algorithm>
#include <limits>

#include "core/exec/stop_poll.h"
#include "core/pruning/branch_pruner.h"

namespace bccskel {

PruningLevels PruningLevelsOf(ThinSet set, Significance& significance, PruningRule rule,
                              const PointSet& keep, const exec::Context& context) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  PruningLevels levels;
  StopPoll poll(context);
  set.ForEachCurvePoint([&](LatticePoint p) {
    if (!poll.Stopped()) levels.Set(p, kNever);
  });
  double level = 0;
  const auto record = [&](LatticePoint p, double worth) {
    level = std::max(level, worth);
    if (double* found = levels.Find(p); found != nullptr) *found = level;
  };
  BranchPruner(set, significance, rule, kNever, keep, context).Run(record);
  return levels;
}

}  // namespace bccskel
