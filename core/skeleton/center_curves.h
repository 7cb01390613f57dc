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

// Does:  finds the middle below the lattice: sets SkeletonPoint::shift of the points of all edges
//        to the way from the smooth curve to the center of the disc across it, as wide as the
//        point's ball, in which each place weighs the square of its distance to the background.
// Why:   lattice points next to a line are 0.7 units off it and smoothing leaves a third of that;
//        and noise draws single points aside, while the distances around them still know the
//        middle. Inside the ball everything is object, so no neighboring limb draws the curve to
//        its side.
// Cost:  up to 29 distances per point of the graph.
// Shapes: `field` belongs to `object`, whose points the graph's are; distances are searched for
//         unless it is Euclidean. The points of its edges follow each other in the order of the
//         edges.
// Errors: CANCELLED, DEADLINE_EXCEEDED.
absl::Status CenterCurves(const Volume& object, const DistanceField& field,
                          const exec::Context& context, SkeletonGraph& graph);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CENTER_CURVES_H_
