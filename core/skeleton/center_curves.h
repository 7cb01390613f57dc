#ifndef BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_
#define BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_

#include <cstdint>

#include "absl/status/status.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/volume/volume.h"

namespace bccskel {

// Of one point, its radius included.
inline constexpr uint64_t kMostDistancesOfPoint = 30;

// Does:  finds the middle with sub-lattice precision: sets SkeletonPoint::shift of the points of
//        all edges to the offset from the smooth curve to the centroid of the disc across it, as
//        wide as the point's ball, with each place weighted by its squared distance to background.
// Why:   lattice points next to a line are 0.7 units off it and smoothing leaves a third of that;
//        noise displaces single points, while the distances around them still locate the middle.
//        Inside the ball everything is object, so no neighboring limb attracts the curve.
// Cost:  up to 29 distances per point of the graph.
// Shapes: `field` belongs to `object`, which contains the points of the graph; unless it is
//         Euclidean, distances are searched for. The points of the graph's edges are stored in the
//         order of the edges.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status CenterCurves(const Volume& object, const DistanceField& field,
                          const exec::Context& context, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_
