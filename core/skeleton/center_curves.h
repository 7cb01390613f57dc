#ifndef BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_
#define BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_

#include <cstdint>

#include "absl/status/status.h"
#include "core/distance/distance_field.h"
#include "core/exec/context.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/volume/volume.h"

namespace bccskel {

// The most distances computed for a point, including its radius.
inline constexpr uint64_t kMostDistancesOfPoint = 30;

// Does:  finds the middle of the object with sub-lattice precision: sets SkeletonPoint::shift of
//        the points of all edges to the offset from the smooth curve to the centroid of the disc
//        across it. The disc is as wide as the point's ball, and each position is weighted by its
//        squared distance to the background.
// Why:   lattice points next to a line are 0.7 units off it, and smoothing leaves a third of that;
//        noise displaces single points, while the distances around them still locate the middle.
//        Everything inside the ball is object, so no adjacent limb attracts the curve.
// Cost:  up to 29 distances per point of the graph.
// Shapes: `field` belongs to `object`, which contains the points of the graph; unless it is
//         Euclidean, distances are searched for. The points of the graph's edges are stored in the
//         order of the edges.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status CenterCurves(const Volume& object, const DistanceField& field,
                          const exec::Context& context, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_
