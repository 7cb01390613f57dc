#include "core/distance/distance_field.h"

#include "core/distance/chamfer_scan.h"
#include "core/distance/euclidean_scan.h"

namespace bccskel {

absl::StatusOr<DistanceField> ComputeDistance(const Volume& object, DistanceKind kind,
                                              const exec::Context& context) {
  return kind == DistanceKind::kEuclidean ? ComputeEuclidean(object, context)
                                          : ComputeChamfer(object, kind, context);
}

}  // namespace bccskel
