#ifndef BCCSKEL_CORE_PRUNING_TUBE_WALL_H_
#define BCCSKEL_CORE_PRUNING_TUBE_WALL_H_

#include "core/pruning/branch_walk.h"
#include "core/pruning/cross_section.h"
#include "core/pruning/thin_set.h"

namespace bccskel {

// Whether a branch leads along the wall of a hollow tube, such as a pipe: across its outer half,
// the object surrounds a hollow. On which side of the hollow the branch lies is arbitrary.
bool LiesInTubeWall(const ThinSet& set, const FreeBranch& branch, CrossSections& sections);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PRUNING_TUBE_WALL_H_
