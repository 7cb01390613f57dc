#ifndef BCCSKEL_CORE_PIPELINE_THIN_POINTS_H_
#define BCCSKEL_CORE_PIPELINE_THIN_POINTS_H_

#include <cstdint>
#include <vector>

#include "core/skeleton/skeleton_graph.h"
#include "core/thinning/thinning.h"
#include "core/volume/volume.h"

namespace bccskel {

// Sets the pass in which each point of the graph became an isthmus; 0 for points that never did.
// Shapes: `isthmuses` in lattice order.
void SetBirths(const std::vector<IsthmusBirth>& isthmuses, SkeletonGraph& graph);

// The same numbers for the points of a volume, in the order of Volume::ForEachPoint().
// Shapes: `isthmuses` in lattice order.
std::vector<int32_t> BirthsOf(const Volume& thin, const std::vector<IsthmusBirth>& isthmuses);

// Shapes: `radii` one per point of `thin`, in the order of Volume::ForEachPoint(). Needs: the
// points of the graph are those of `thin`.
void SetRadii(const std::vector<float>& radii, const Volume& thin, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PIPELINE_THIN_POINTS_H_
