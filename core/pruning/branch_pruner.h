#ifndef BCCSKEL_CORE_PRUNING_BRANCH_PRUNER_H_
#define BCCSKEL_CORE_PRUNING_BRANCH_PRUNER_H_

#include <functional>
#include <optional>
#include <queue>
#include <set>
#include <utility>
#include <vector>

#include "core/exec/context.h"
#include "core/pruning/branch_walk.h"
#include "core/pruning/point_table.h"
#include "core/pruning/prune.h"
#include "core/pruning/significance.h"
#include "core/pruning/thin_set.h"
#include "core/pruning/turned_tips.h"

namespace bccskel {

// Does:  removes spurious branches, the least significant first. After each removal it evaluates
//        the junction again, since two of three branches become one.
// Why it is right: a branch is removed starting from its end, and an end point is simple. Then
//   points at the junction that have become simple are removed one by one. So only branches with a
//   free end can vanish, and a path with two ends stays.
// The value of a branch is the number that the rule compares with the threshold. The branches
// removed at one threshold are the first ones removed at any larger threshold, so the results of
// all thresholds are nested.
// Cost:  follows the points of the branches with an end; each removal visits one junction.
class BranchPruner {
 public:
  // A removed point, and the value of its branch.
  using OnRemoved = std::function<void(LatticePoint, double)>;

  // `threshold` in the unit of the rule: none for significance, lattice units for a length, radii
  // of the junction for a relative length, passes for persistence. The arguments must outlive the
  // pruner.
  BranchPruner(ThinSet& set, Significance& significance, PruningRule rule, double threshold,
               const PointSet& keep, const exec::Context& context)
      : set_(set),
        significance_(significance),
        rule_(rule),
        threshold_(threshold),
        keep_(keep),
        context_(context) {}

  // `turned`, if given, receives the tips that turn aside where branches are removed. Stops early
  // if the context requests it.
  void Run(const OnRemoved& on_removed, TurnedTips* turned = nullptr);

 private:
  bool IsEnd(LatticePoint p) const { return set_.Contains(p) && set_.IsEnd(p); }
  // Where an insignificant limb or the end of one forks into two branches, neither significant by
  // itself, one of them leads the limb on: that with which the limb is more significant. Returns
  // the other one; elsewhere `branch`, the next to be removed, of this worth.
  FreeBranch LessOfTwins(const FreeBranch& branch, double worth) const;
  // The only other branch with a free end at the junction, if it is insignificant.
  std::optional<FreeBranch> TwinOf(const FreeBranch& branch) const;
  // The significance of the limb that ends at `end` if `going` is removed.
  double LimbWithout(const FreeBranch& going, LatticePoint end) const;
  void NoteTurned(const FreeBranch& branch, TurnedTips& turned) const;
  void JudgeAll();
  void Judge(const FreeBranch& branch);
  void JudgeAround(const std::set<LatticePoint>& places);
  void FindEndsBeyond(LatticePoint p, const std::set<LatticePoint>& sources,
                      std::set<LatticePoint>& ends) const;

  bool MayGo(const FreeBranch& branch) const;
  std::optional<double> WorthIfSpurious(const FreeBranch& branch) const;
  // Need: the branch has a junction.
  double WorthOf(const FreeBranch& branch) const;
  double BallAt(LatticePoint junction) const;
  double LengthOfBranch(const FreeBranch& branch) const;

  using Turn = std::pair<double, LatticePoint>;

  ThinSet& set_;
  Significance& significance_;
  const PruningRule rule_;
  const double threshold_;
  const PointSet& keep_;
  const exec::Context& context_;
  std::priority_queue<Turn, std::vector<Turn>, std::greater<>> turns_;
};

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

#endif  // BCCSKEL_CORE_PRUNING_BRANCH_PRUNER_H_
