#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"

namespace bccskel {

// ComputeDistance() for kChamfer and kChamferOptimal.
absl::StatusOr<DistanceField> ComputeChamfer(const Volume& object, DistanceKind kind,
                                             const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_SCAN_H_
