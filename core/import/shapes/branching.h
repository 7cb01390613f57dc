#ifndef BCCSKEL_CORE_IMPORT_SHAPES_BRANCHING_H_
#define BCCSKEL_CORE_IMPORT_SHAPES_BRANCHING_H_

#include <cstdint>
#include <vector>

#include "core/import/shapes/solids.h"

namespace bccskel::shapes {

enum class Taper : uint8_t { kNone, kToTheNextBranch };

// A trunk of radius 1 along z that forks into two `levels` times.
struct BranchingPlan {
  int levels = 3;
  int side_branches = 0;  // one more tip each, on the trunk
  double trunk_length = 10;
  double length_ratio = 0.8;  // of a branch to the one it comes from
  double radius_ratio = 0.79;
  double gap = 0.9;  // least distance between branches that do not meet
  Taper taper = Taper::kNone;
};

// Branches that touch only where they fork, so that the union is contractible. 2^levels +
// side_branches tips.
std::vector<Solid> GrowBranches(const BranchingPlan& plan, uint64_t seed);

}  // namespace bccskel::shapes

#endif  // BCCSKEL_CORE_IMPORT_SHAPES_BRANCHING_H_
