#ifndef BCCSKEL_CORE_EXPORT_RECONSTRUCT_UNION_OF_BALLS_H_
#define BCCSKEL_CORE_EXPORT_RECONSTRUCT_UNION_OF_BALLS_H_

#include <array>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/skeleton/skeleton_graph.h"
#include "core/volume/volume.h"

namespace bccskel {

// All that lies nearer to the center than the radius.
struct OpenBall {
  std::array<double, 3> center;  // lattice coordinates
  double radius;                 // world units; where spacings differ, no ball of the lattice
};

// The balls of a skeleton's points, those of nodes, edges and sheets: each the largest inside the
// object.
std::vector<OpenBall> BallsOf(const SkeletonGraph& graph);

// A place in the world in lattice coordinates: the way back of Placement::ToWorld().
// Needs: a direction matrix that can be inverted.
std::array<double, 3> LatticePlaceOf(const WorldPoint& p, const Placement& placement);

// The lattice points of the extent that lie in any of the balls. Of the placement only the spacings
// matter.
// Cost:   follows the rows of points in each ball.
// Errors: CANCELLED, DEADLINE_EXCEEDED; those of Volume::Create().
absl::StatusOr<Volume> UnionOfBalls(std::span<const OpenBall> balls, const LatticeExtent& extent,
                                    const Placement& placement, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_RECONSTRUCT_UNION_OF_BALLS_H_
