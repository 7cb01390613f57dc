#ifndef BCCSKEL_CORE_THINNING_STUBBLE_H_
#define BCCSKEL_CORE_THINNING_STUBBLE_H_

#include "core/thinning/mark_removable.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// The stubble points (Condition 6) among the end points of one brick, judged on the frozen object.
// A stubble point's neighbor is never removed in the same pass: it is neither an end point nor
// simple, so the topology is kept.
BrickBits SelectStubble(const ThinningState& state, const MarkedBrick& end_points,
                        StubblePolicy policy);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_STUBBLE_H_
