#ifndef BCCSKEL_CORE_DISTANCE_EUCLIDEAN_SCAN_H_
#define BCCSKEL_CORE_DISTANCE_EUCLIDEAN_SCAN_H_

#include "absl/status/statusor.h"
#include "core/distance/distance_field.h"

namespace bccskel {

// ComputeDistance() for kEuclidean.
absl::StatusOr<DistanceField> ComputeEuclidean(const Volume& object, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_EUCLIDEAN_SCAN_H_
