#ifndef BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_
#define BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/prune.h"
#include "core/thinning/thinning.h"

namespace bccskel::test {

// What thinning leaves, before anything is pruned.
struct RawCurves {
  RawCurves(Volume whole, SkeletonKind kind)
      : object(std::move(whole)), field(*ComputeDistance(object, DistanceKind::kEuclidean, {})) {
    const ThinningOptions options = {.method = ThinningMethod::kSymmetric, .kind = kind};
    ThinningResult result = *ThinObject(object, field, options, {});
    thin = std::move(result.thin);
    radii = *ExactRadii(thin, ExactRadius(object, field), {});
    if (kind != SkeletonKind::kIsthmusCurve && kind != SkeletonKind::kSurface) return;
    thin.ForEachPoint([&](LatticePoint p) {
      const auto found = std::ranges::find(result.isthmuses, p, &IsthmusBirth::point);
      births.push_back(found == result.isthmuses.end() ? 0 : found->pass);
    });
  }

  PrunedSkeleton PrunedBy(PruningRule rule, double threshold) const {
    const PruningOptions options = {rule, threshold, TipPlacement::kAsThinned};
    return *Prune({thin, radii, births}, object, ExactRadius(object, field), {}, options, {});
  }

  Volume object;
  DistanceField field;
  Volume thin;
  std::vector<float> radii;
  std::vector<int32_t> births;  // empty where the kind keeps no isthmuses
};

// The number of ends after everything, with this pruning.
inline size_t EndsOf(const Volume& object, const PruningOptions& pruning = {}) {
  SkeletonizeOptions options;
  options.pruning = pruning;
  const SkeletonGraph graph = Skeletonize(object, options, {})->graph;
  return static_cast<size_t>(std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind));
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_
