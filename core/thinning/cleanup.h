#ifndef BCCSKEL_CORE_THINNING_CLEANUP_H_
#define BCCSKEL_CORE_THINNING_CLEANUP_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

// Does:  removes what the direction passes leave thick, so that no candidate is both simple and not
//        an end point.
// Paper: goes beyond it. The directional rule can get stuck: the smallest such object has 9 points.
// Why it is right: the four subfields (x + y + z) mod 4 hold no two adjacent points, so all points
//        of one subfield that satisfy Conditions 1 and 2 are independent and can go at once.
//        Subfields 0 to 3 in turn, until a round removes nothing.
// Cost:  bricks where nothing can be simple are skipped by word tests; one to three rounds.
// Returns: the number of points removed.
// Errors:  CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<uint64_t> CleanUpThinness(const exec::Context& context, ThinningState& state);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_CLEANUP_H_
