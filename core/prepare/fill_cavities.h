#ifndef BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_
#define BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_

#include <cstdint>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// Does:  turns every background component except the outside into object; counts them.
// Why it is right: the rest of the background is only the outside, so no cavity remains, and
//   objects inside a cavity become part of what encloses them. Filling a cavity that is a ball
//   changes nothing else; one with handles also removes as many loops.
// Cost:  labels the background; creates bricks where a cavity needs them.
// Errors: RESOURCE_EXHAUSTED if the object would have more than max_bricks bricks; CANCELLED,
//         DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> FillCavities(const Volume& object, uint64_t max_bricks,
                                           const exec::Context& context);

// The number of bricks of the object after its cavities are filled.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<uint64_t> BricksWithCavitiesFilled(const Volume& object,
                                                  const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_FILL_CAVITIES_H_
