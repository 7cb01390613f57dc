#ifndef BCCSKEL_CORE_PREPARE_DENOISE_H_
#define BCCSKEL_CORE_PREPARE_DENOISE_H_

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/prepare/changed_volume.h"

namespace bccskel {

// Does:  one pass for all points at once: an object point stays if at least 7 of its 14 neighbors
//        are object points, a background point joins if at least 8 are; that is, every point is set
//        to the majority of itself and its neighbors.
// Why it is right: the sum of fifteen bits is at least eight if its bit of weight eight is set, so
//   a tree of full adders counts for 512 points at once. A point in a brick without points has at
//   most three neighbors of its own sublattice outside that brick, so it can join only if an
//   adjacent brick of the other sublattice is stored; and a point outside the extent has at most
//   five neighbors inside.
// Cost:  about 70 logic operations per brick stored or missing beside a stored one.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<ChangedVolume> Denoise(const Volume& object, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_DENOISE_H_
