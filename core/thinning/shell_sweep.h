#ifndef BCCSKEL_CORE_THINNING_SHELL_SWEEP_H_
#define BCCSKEL_CORE_THINNING_SHELL_SWEEP_H_

#include <cstdint>
#include <functional>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/shells/shells.h"
#include "core/thinning/pass_rule.h"
#include "core/thinning/sweep_partners.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"

namespace bccskel {

struct SweepPlan {
  const Shells& shells;
  int32_t last = 0;  // shell
  StubblePolicy stubble = StubblePolicy::kKeepTwo;
  // Called on worker 0 after each shell, while the other workers wait.
  std::function<void(int32_t shell)> after_shell = nullptr;
  // Null: this sweep has the whole object.
  SweepPartners* partners = nullptr;
  // Shells that were thinned earlier, fewer than `last`: the state is their result. Totals count
  // the rest.
  int32_t done = 0;
};

// The parts of a plan that follow from the options.
int32_t LastShellOf(const ThinningOptions& options, const Shells& shells);
StubblePolicy StubbleOf(const ThinningOptions& options);

struct SweepTotals {
  uint64_t removed = 0;
  uint32_t passes = 0;
};

// Does:  the algorithm of section 5: for each shell, one cycle of the rule's passes; on the last
//        shell cycles repeat until a whole cycle removes nothing.
// Paper: Figs. 9 and 10; Condition 5 (candidates are the remaining points of shells <= the current
//        one) and Condition 6 (stubble points are removed in the same pass).
// Why it is right: a pass marks points on an object that does not change around them and removes
//   them afterwards, as the proofs of the rules require, for any order and any number of workers.
// Cost:  with several passes per cycle, each pass visits a brick until neither the brick nor one
//        around it has changed for a whole cycle; after that, and always with one pass per cycle,
//        only after a change.
// Differs from the paper: bricks of 512 points instead of point lists; the same points removed.
// Threads: worker w owns a contiguous range of bricks (BrickShares); a pass has one more barrier
//          than steps.
// Partners: exchange the points that bricks lose once per pass, and sums once per cycle; the same
//           points removed. Totals and progress are those of all; stop requests take effect after a
//           cycle.
// Errors:  CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<SweepTotals> SweepShells(const SweepPlan& plan, PassRule& rule,
                                        const exec::Context& context, ThinningState& state);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SHELL_SWEEP_H_
