#ifndef BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_
#define BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// Does:  makes object of every background component but the outside; counts them.
// Why it is right: what is left of the background is the outside alone, so no cavity remains, and
//        objects inside a cavity become part of what encloses them. A cavity that is a ball takes
//        nothing else with it; one with handles takes as many loops.
// Cost:  labels the background; bricks that are not stored are made where a cavity has some.
// Errors: RESOURCE_EXHAUSTED when the object would have more than max_bricks bricks; CANCELLED,
//         DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> FillCavities(const Volume& object, uint64_t max_bricks,
                                           const exec::Context& context);

// The bricks that the object will have when its cavities are filled.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<uint64_t> BricksWithCavitiesFilled(const Volume& object,
                                                  const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_
