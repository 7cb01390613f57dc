#ifndef BCCSKEL_CORE_THINNING_CLEANUP_H_
#define BCCSKEL_CORE_THINNING_CLEANUP_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// Does:  removes the thick spots that direction passes leave, so that no candidate is both simple
//        and not an end point.
// Paper: goes beyond it. The directional rule can get stuck: the smallest such object has 9 points.
// Why it is right: no two points of one of the four subfields (x + y + z) mod 4 are adjacent, so
//   all points of one subfield that satisfy Conditions 1 and 2 are independent and can be removed
//   at once. Subfields 0 to 3 take turns until a round removes nothing.
// Cost:  word tests skip bricks where nothing can be simple; one to three rounds.
// Returns: the number of points removed.
// Errors:  CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<uint64_t> CleanUpThinness(const exec::Context& context, ThinningState& state);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_CLEANUP_H_
