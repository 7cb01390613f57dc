#ifndef BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_
#define BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/thinning/mark_removable.h"

namespace bccskel {

// Other sweeps of the same object at the same time, each with bricks of its own. A sweep needs to
// know the ghosts: the bricks of others next to its own, in all 26 directions and of both
// sublattices. They are part of its state like its own bricks.
// Why one layer of ghosts is enough: whether a pass removes a point depends on points up to four
// steps away (symmetric pass; three for stubble, one for directions). A step leads at most to the
// next cell along each axis, and a brick has at least four. So all marks of own bricks are right;
// those of ghosts may not be, so their owners send the points that these lose.
// Threads: called on worker 0 of a sweep, at the same stages of all partners' sweeps.
class SweepPartners {
 public:
  virtual ~SweepPartners() = default;

  // The bricks of this sweep.
  virtual exec::Share own() const = 0;

  // Sends the points that own bricks lose in a pass. A brick may occur more than once.
  virtual void Tell(const MarkedBrick& lost) = 0;
  // Returns the points that ghosts lose in the pass, once all partners have sent theirs. Valid
  // until the next call.
  virtual std::span<const MarkedBrick> Hear() = 0;

  // Replaces each number by its sum over all partners.
  virtual void Sum(std::span<uint64_t> numbers) = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_
