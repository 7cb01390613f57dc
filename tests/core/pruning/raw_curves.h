#ifndef BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_
#define BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/pipeline/skeletonize.h"
#include "core/pruning/point_table.h"
#include "core/pruning/prune.h"
#include "core/skeleton/thin_skeleton.h"
#include "core/thinning/thinning.h"

namespace bccskel::test {

// What thinning leaves, before anything is pruned.
struct RawCurves {
  RawCurves(Volume whole, SkeletonKind kind)
      : object(std::move(whole)), field(*ComputeDistance(object, DistanceKind::kEuclidean, {})) {
    const ThinningOptions options = {.method = ThinningMethod::kSymmetric, .kind = kind};
    ThinningResult result = *ThinObject(object, field, options, {});
    if (kind == SkeletonKind::kIsthmusCurve || kind == SkeletonKind::kSurface) {
      skeleton.births = BirthsOf(result);
    }
    skeleton.points = std::move(result.thin);
    skeleton.radii = *ExactRadii(skeleton.points, ExactRadius(object, field), {});
  }

  ThinSkeleton PrunedBy(PruningRule rule, double threshold) const {
    const PruningOptions options = {rule, threshold, TipPlacement::kAsThinned};
    return *Prune(skeleton, {object, ExactRadius(object, field)}, {}, options, {});
  }

  Volume object;
  DistanceField field;
  ThinSkeleton skeleton;
};

// Of the points that have one.
inline PointTable<double> LevelsOf(const ThinSkeleton& skeleton) {
  PointTable<double> levels;
  size_t n = 0;
  skeleton.points.ForEachPoint([&](LatticePoint p) {
    if (const double level = skeleton.levels[n++]; level != kNoLevel) levels.Set(p, level);
  });
  return levels;
}

// The number of ends after everything, with this pruning.
inline size_t EndsOf(const Volume& object, const PruningOptions& pruning = {}) {
  SkeletonizeOptions options;
  options.pruning = pruning;
  const SkeletonGraph graph = Skeletonize(object, options, {})->graph;
  return static_cast<size_t>(std::ranges::count(graph.nodes, NodeKind::kEnd, &SkeletonNode::kind));
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PRUNING_RAW_CURVES_H_
