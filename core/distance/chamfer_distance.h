#ifndef BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_
#define BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_

#include "core/distance/distance_field.h"

// The names of distance_field.h before there were other kinds.

namespace bccskel {

using ChamferField = DistanceField;

inline absl::StatusOr<DistanceField> ComputeChamferDistance(const Volume& object,
                                                            const exec::Context& context) {
  return ComputeDistance(object, DistanceKind::kChamfer, context);
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_DISTANCE_CHAMFER_DISTANCE_H_
