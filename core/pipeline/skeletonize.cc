#include "core/pipeline/skeletonize.h"

#include "absl/strings/str_format.h"
#include "core/distance/distance_field.h"
#include "core/distance/exact_radius.h"
#include "core/exec/stage_clock.h"
#include "core/exec/status_macros.h"
#include "core/pipeline/method_in_words.h"

namespace bccskel {
namespace {

absl::StatusOr<Certificate> Certify(const Volume& object, const Volume& thin,
                                    const exec::Context& context) {
  Certificate certificate;
  BCCSKEL_ASSIGN_OR_RETURN(certificate.input, CountBettiNumbers(object, context));
  BCCSKEL_ASSIGN_OR_RETURN(certificate.skeleton, CountBettiNumbers(thin, context));
  certificate.simple_points_left = CountSimpleNonEndPoints(thin, context);
  if (certificate.TopologyKept()) return certificate;
  const BettiNumbers &in = certificate.input, &out = certificate.skeleton;
  return absl::InternalError(absl::StrFormat(
      "thinning changed the topology: components %d -> %d, loops %d -> %d, cavities %d -> %d",
      in.components, out.components, in.loops, out.loops, in.cavities, out.cavities));
}

bool HasCurvesToPrune(const SkeletonizeOptions& options) {
  const bool asked = options.pruning.rule != PruningRule::kNone ||
                     options.pruning.tips != TipPlacement::kAsThinned;
  return asked && options.thinning.last_shell == 0 && options.thinning.kind == SkeletonKind::kCurve;
}

// Radii of a few points are searched for one by one. A search costs about as much as measuring
// eight bricks, so for many it is cheaper to measure all; both give the same bits.
absl::Status PrepareRadii(const Volume& object, const Volume& thin, DistanceField& distance,
                          const exec::Context& context) {
  if (distance.kind() == DistanceKind::kEuclidean) return absl::OkStatus();
  if (8 * thin.PointCount() <= object.brick_count()) return absl::OkStatus();
  distance = DistanceField(distance.kind(), distance.weights(), DistanceField::Values(), 0);
  BCCSKEL_ASSIGN_OR_RETURN(distance, ComputeDistance(object, DistanceKind::kEuclidean, context));
  return absl::OkStatus();
}

}  // namespace

absl::Status CheckSkeletonizeOptions(const SkeletonizeOptions& options) {
  BCCSKEL_RETURN_IF_ERROR(CheckThinningOptions(options.thinning));
  return CheckPruningOptions(options.pruning);
}

absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object,
                                              const SkeletonizeOptions& options,
                                              const exec::Context& context) {
  BCCSKEL_RETURN_IF_ERROR(CheckSkeletonizeOptions(options));
  SkeletonizeResult result;
  result.method = MethodInWords(options.thinning, options.distance);
  result.object_points = object.PointCount();
  exec::StageClock clock;
  BCCSKEL_ASSIGN_OR_RETURN(DistanceField distance,
                           ComputeDistance(object, options.distance, context));
  result.timings.distance = clock.Lap();
  BCCSKEL_ASSIGN_OR_RETURN(ThinningResult thinned,
                           ThinToCurve(object, distance, options.thinning, context));
  result.thin = std::move(thinned.thin);
  result.last_shell = thinned.last_shell;
  result.timings.shells = thinned.times.shells;
  result.timings.thinning = thinned.times.passes;
  result.timings.cleanup = thinned.times.cleanup;
  clock.Lap();
  BCCSKEL_RETURN_IF_ERROR(PrepareRadii(object, result.thin, distance, context));
  BCCSKEL_ASSIGN_OR_RETURN(std::vector<float> radii,
                           ExactRadii(result.thin, object, distance, context));
  if (HasCurvesToPrune(options)) {
    BCCSKEL_ASSIGN_OR_RETURN(PrunedSkeleton pruned,
                             Prune(result.thin, radii, object, distance, options.thinning.keep,
                                   options.pruning, context));
    result.thin = std::move(pruned.thin);
    radii = std::move(pruned.radii);
  }
  result.skeleton_points = result.thin.PointCount();
  result.timings.pruning = clock.Lap();
  BCCSKEL_ASSIGN_OR_RETURN(result.certificate, Certify(object, result.thin, context));
  result.timings.certificate = clock.Lap();
  BCCSKEL_ASSIGN_OR_RETURN(result.graph, TraceSkeleton(result.thin, radii, context));
  result.sha256 = SkeletonDigest(result.graph);
  result.timings.graph = clock.Lap();
  result.timings.total = clock.Total();
  return result;
}

}  // namespace bccskel
