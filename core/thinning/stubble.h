#ifndef BCCSKEL_CORE_THINNING_STUBBLE_H_
#define BCCSKEL_CORE_THINNING_STUBBLE_H_

#include "core/thinning/mark_removable.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// End points of one brick, judged on the frozen object.
struct JudgedEnds {
  // Condition 6. The neighbor of a stubble point is never removed in the same pass: it is neither
  // an end point nor simple. So the topology stays.
  BrickBits stubble;
  // End points that no pass will remove: rules remove end points only as stubble, and the neighbor
  // has at most two neighbors and gets no more.
  BrickBits stay;
};

JudgedEnds JudgeEnds(const ThinningState& state, const MarkedBrick& end_points,
                     StubblePolicy policy);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_STUBBLE_H_
