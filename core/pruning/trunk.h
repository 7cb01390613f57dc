#ifndef BCCSKEL_CORE_PRUNING_TRUNK_H_
#define BCCSKEL_CORE_PRUNING_TRUNK_H_

#include <cstddef>
#include <optional>

#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/largest_run.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Measures short limbs that leave a trunk. Lines across such a limb run along the trunk, so it
// seems wide.

// The first place of the run outside the ball at the junction; kRunPlaces if there is none.
size_t FirstPlaceOutside(const ThinSet& set, const BranchPath& path, const Run& run);

// By how much the object is wider than the radius across a run: the median of its places outside
// the ball at the junction, each measured to the narrower side. No value if they are fewer than
// three. Lattice units.
std::optional<double> WidthBesideTrunk(const ThinSet& set, const BranchPath& path, const Run& run,
                                       CrossSections& sections);

// Whether the other branches at the junction belong to a trunk: some radii on, the object is round
// across each of them, and one is about as thick as the junction. In a plate or a flat limb, and in
// a head on a neck, they do not.
// Needs: the branch has a junction.
bool LeavesTrunk(const ThinSet& set, const FreeBranch& branch, CrossSections& sections);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TRUNK_H_
