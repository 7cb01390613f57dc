#include "tests/bench/reference_skeleton.h"

#include <utility>

#include "core/distance/distance_field.h"
#include "core/distance/exact_radius.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/prune.h"
#include "core/skeleton/junction_merger.h"
#include "core/skeleton/skeleton_graph.h"
#include "tests/support/reference_thinner.h"

namespace bccskel::test {

absl::StatusOr<std::string> ReferenceDigest(const Volume& object) {
  VolumeBuilder builder(object.extent(), object.placement());
  for (const LatticePoint p : ReferenceThin(object, {.method = ThinningMethod::kDirectional}))
    builder.Add(p);
  BCCSKEL_ASSIGN_OR_RETURN(const Volume thin, std::move(builder).Build());
  BCCSKEL_ASSIGN_OR_RETURN(const DistanceField distance,
                           ComputeDistance(object, DistanceKind::kChamfer, {}));
  const ExactRadius radius(object, distance);
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<float> radii, ExactRadii(thin, radius, {}));
  BCCSKEL_ASSIGN_OR_RETURN(const ThinSkeleton pruned,
                           Prune({thin, std::move(radii)}, {object, radius}, {}, {}, {}));
  BCCSKEL_ASSIGN_OR_RETURN(SkeletonGraph graph, TraceSkeleton(pruned, {}));
  BCCSKEL_RETURN_IF_ERROR(MergeJunctions(SkeletonizeOptions().junction_reach, {}, graph));
  return SkeletonDigest(graph);
}

}  // namespace bccskel::test
