#ifndef BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_
#define BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_

#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/thinning/mark_removable.h"

namespace bccskel {

// Others who sweep the same object at the same time, each with bricks of its own. What a sweep has
// to know of theirs are the ghosts: the bricks of others that lie beside its own, in all 26
// directions and of both sublattices. They are part of its state like its own.
// Why one layer of ghosts is enough: whether a point goes in a pass depends on points up to four
// steps away (a symmetric pass; three for stubble, one for directions). A step leads no farther
// than to the next cell along each axis, and no brick has less than four. So all marks of own
// bricks are right; those of ghosts may not be, and their owners tell instead what they lose.
// Threads: called on worker 0 of a sweep, at the same points of all partners' sweeps.
class SweepPartners {
 public:
  virtual ~SweepPartners() = default;

  // The bricks that are this sweep's own.
  virtual exec::Share own() const = 0;

  // Sends what own bricks lose in a pass. A brick may come more than once.
  virtual void Tell(const MarkedBrick& lost) = 0;
  // Returns what ghosts lose in it, once all have sent. Valid until the next call.
  virtual std::span<const MarkedBrick> Hear() = 0;

  // Puts the sum over all partners in the place of each number.
  virtual void Sum(std::span<uint64_t> numbers) = 0;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SWEEP_PARTNERS_H_
