#ifndef BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_
#define BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_

#include <functional>
#include <map>
#include <span>
#include <vector>

#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/surface_noise.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Ends of branches that turn away from the direction of their limbs, such as into a corner of a
// screw's head or into one ear of a bear.
// Does:  If the end of a limb forks into two spurious branches and pruning removes one, the other
//        becomes the end of the limb. So this records the other before the removal, if
//        - it leaves the direction of the limb by 40 to 90 degrees: a smaller angle continues the
//          limb, a larger one belongs to another limb;
//        - it is at most 1.6 radii of the fork long, so it lies in the cap of the limb, or it may
//          be a rib, such as one of those of a disc at the end of a shaft: longer than 1.2 radii,
//          but no longer than the limb. Then the angle may be 96 degrees;
//        - the limb before it is a curve at least two radii long and, if that curve has a free end
//          as well, is worth at least twice as much.
// Why it is right: nothing is removed here, and recorded points form a path from an end.
class TurnedTips {
 public:
  using WorthOf = std::function<double(const FreeBranch&)>;

  // Call before `going` is removed. Needs: `cluster` holds the connected points with at least three
  // neighbors at its junction; `worth_of` is below the threshold for spurious branches.
  void Note(const ThinSet& set, const FreeBranch& going, std::span<const LatticePoint> cluster,
            const WorthOf& worth_of);

  // Forgets tips worth 1.15 thresholds or more and ribs worth one: those are limbs.
  void DropFrom(double threshold);

  struct Tip {
    std::vector<LatticePoint> points;  // the end first
    double worth = 0;
    bool in_cap = false;
    bool is_rib = false;  // if it lies in a flat part
  };

  // The longest recorded tip that is the beginning, but not all, of `branch` (FreeBranch::points);
  // null if there is none.
  const Tip* At(std::span<const LatticePoint> branch) const;

 private:
  std::map<LatticePoint, std::vector<Tip>> tips_;  // by the end
};

// Whether the object is wide across the rib, at the end of a limb that is not, and no noise.
// Needs: `branch` begins with the points of the rib.
bool LiesInDisc(std::span<const LatticePoint> rib, std::span<const LatticePoint> branch,
                const ThinSet& set, CrossSections& sections, const SurfaceNoise& noise);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TURNED_TIPS_H_
