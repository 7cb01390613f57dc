#ifndef BCCSKEL_CORE_THINNING_STUBBLE_H_
#define BCCSKEL_CORE_THINNING_STUBBLE_H_

#include "core/thinning/mark_removable.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// End points of one brick, judged on the frozen object.
struct JudgedEnds {
  // Condition 6. A stubble point's neighbor is never removed in the same pass: it is neither an end
  // point nor simple, so the topology is kept.
  BrickBits stubble;
  // No pass will remove these: no rule removes an end point but as stubble, and the neighbor has
  // two neighbors at most and gets no more.
  BrickBits stay;
};

JudgedEnds JudgeEnds(const ThinningState& state, const MarkedBrick& end_points,
                     StubblePolicy policy);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_STUBBLE_H_
