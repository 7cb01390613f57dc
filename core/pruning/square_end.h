#ifndef BCCSKEL_CORE_PRUNING_SQUARE_END_H_
#define BCCSKEL_CORE_PRUNING_SQUARE_END_H_

#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Whether a branch leads into a corner of the square end of a strip: at its junction the curve
// forks into two branches with free ends, the straight line between these ends lies in the object
// and is about as long as the limb before the fork is wide, and that limb is flat. Between two
// fingers the line leaves the object; lobes of a fin are farther apart than its stalk is wide; the
// curves into the corners of a plate have no limb before them; the trunk behind two legs that
// spread is narrower than the pelvis. Needs: the branch has a junction.
bool LeadsIntoCornerOfStrip(const ThinSet& set, const FreeBranch& branch, CrossSections& sections);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_SQUARE_END_H_
