#ifndef BCCSKEL_CORE_PRUNING_COLLAR_H_
#define BCCSKEL_CORE_PRUNING_COLLAR_H_

#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Whether a branch leads from a shaft into a collar around it, such as a flange or a wheel: a flat
// part that extends about as far from the shaft to all sides. Where in it the branch ends is
// arbitrary. Blades and fins leave gaps between them, and a plate alone has no shaft.
// Needs: the branch has a junction.
bool LeadsIntoCollar(const ThinSet& set, const FreeBranch& branch, CrossSections& sections);

// Whether where a branch lies is arbitrary: it leads into a collar, or along the wall of a tube.
// Needs: the branch has a junction.
bool IsArbitrary(const ThinSet& set, const FreeBranch& branch, CrossSections& sections);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_COLLAR_H_
