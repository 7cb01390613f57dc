#ifndef BCCSKEL_CORE_PREPARE_BALL_CLOSING_H_
#define BCCSKEL_CORE_PREPARE_BALL_CLOSING_H_

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/exec/memory_budget.h"
#include "core/volume/volume.h"

namespace bccskel {

// The background points of the object's extent that a ball of this radius (lattice units) does not
// reach from outside: the closing of the object by the ball, without the object.
// Errors: of the budget; CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<Volume> OutOfReach(const Volume& object, double radius, exec::MemoryBudget& memory,
                                  const exec::Context& context);

// OK if the budget has the memory that OutOfReach() needs.
absl::Status CheckRoomForBall(const Volume& object, double radius, exec::MemoryBudget& memory);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BALL_CLOSING_H_
