#ifndef BCCSKEL_CORE_RECONSTRUCT_UNION_OF_BALLS_H_
#define BCCSKEL_CORE_RECONSTRUCT_UNION_OF_BALLS_H_

#include <array>
#include <span>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel {

// All that lies nearer to the center than the radius. Lattice units.
struct OpenBall {
  std::array<double, 3> center;
  double radius;
};

// A place in the world in lattice coordinates: the way back of Placement::ToWorld().
// Needs: a direction matrix that can be inverted.
std::array<double, 3> LatticePlaceOf(const WorldPoint& p, const Placement& placement);

// The lattice points of the extent that lie in any of the balls.
// Cost:   follows the rows of points in each ball.
// Errors: CANCELLED, DEADLINE_EXCEEDED; those of Volume::Create().
absl::StatusOr<Volume> UnionOfBalls(std::span<const OpenBall> balls, const LatticeExtent& extent,
                                    const Placement& placement, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_RECONSTRUCT_UNION_OF_BALLS_H_
