#include "core/distance/distance_field.h"

#include "core/distance/chamfer_scan.h"
#include "core/distance/euclidean_stream.h"
#include "core/exec/status_macros.h"

namespace bccskel {

absl::StatusOr<DistanceField> ComputeDistance(const Volume& object, DistanceKind kind,
                                              const exec::Context& context) {
  if (kind != DistanceKind::kEuclidean) return ComputeChamfer(object, kind, context);
  BCCSKEL_ASSIGN_OR_RETURN(std::optional<DistanceField> field,
                           StreamEuclidean(object, context, nullptr, KeepField::kAlways));
  return std::move(field).value();
}

}  // namespace bccskel
