#ifndef BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_
#define BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_

#include <cstdint>
#include <string>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/pipeline/stage_timings.h"
#include "core/pruning/prune.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel {

struct SkeletonizeOptions {
  // The symmetric method puts curves closer to the center than the paper's directions do.
  ThinningOptions thinning = {.method = ThinningMethod::kSymmetric};
  DistanceKind distance = DistanceKind::kChamfer;  // that makes the shells
  // Not done where thinning stops at a shell, which leaves no curves.
  PruningOptions pruning = {};
};

// Errors: INVALID_ARGUMENT, with the value and the limit.
absl::Status CheckSkeletonizeOptions(const SkeletonizeOptions& options);

struct SkeletonizeResult {
  SkeletonGraph graph;
  Volume thin;
  Certificate certificate;
  StageTimings timings;
  uint64_t object_points = 0;
  uint64_t skeleton_points = 0;
  int32_t last_shell = 0;
  std::string method;  // MethodInWords()
  std::string sha256;  // SkeletonDigest(graph)
};

// The straight path of an object: distance, shells, thinning, pruning, certificate, graph.
// An empty object gives an empty graph.
// Errors: INVALID_ARGUMENT (options), CANCELLED, DEADLINE_EXCEEDED; INTERNAL if the certificate
//         shows that topology was lost, which would be a defect of this library.
absl::StatusOr<SkeletonizeResult> Skeletonize(const Volume& object,
                                              const SkeletonizeOptions& options,
                                              const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_SKELETONIZE_H_
