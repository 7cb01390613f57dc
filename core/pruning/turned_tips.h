#ifndef BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "core/pruning/branch_walk.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// The ends of limbs that turn aside: into a corner of a screw's head, or one ear of a bear.
// Does:  Where the end of a limb forks, and one branch goes, the limb goes on into the other, which
//        is as spurious. So this remembers the other while both are there, if the branch
//        - leaves the way of the limb by 40 to 90 degrees: what goes straight on is the limb, what
//          turns back is another one;
//        - is at most 1.6 radii of the fork long, so it lies in the cap of the limb;
//        - has a limb before it, a curve that goes on for two radii and, where that ends, too, is
//          worth twice as much as the branch.
// Why it is right: nothing is removed here; the points are those of a path from an end.
class TurnedTips {
 public:
  using WorthOf = std::function<double(const FreeBranch&)>;

  // Call before `going` goes. Needs: `cluster` are the connected points of `set` with three and
  // more neighbors at its junction; `worth_of` is below the threshold for spurious branches.
  void Note(const ThinSet& set, const FreeBranch& going, std::span<const LatticePoint> cluster,
            const WorthOf& worth_of);

  // Forgets what is worth this threshold, by more than a twin of a spurious branch may be.
  void DropFrom(double threshold);

  // The longest way aside, the end first, that a branch begins with; empty if it has none, or
  // nothing before it. Shapes: `branch` as FreeBranch::points.
  std::span<const LatticePoint> At(std::span<const LatticePoint> branch) const;

 private:
  struct Tip {
    std::vector<LatticePoint> points;  // the end first
    double worth = 0;
  };

  std::map<LatticePoint, std::vector<Tip>> tips_;  // by the end
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_
