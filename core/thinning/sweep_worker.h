#ifndef BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_
#define BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/thinning/pass_rule.h"
#include "core/thinning/shell_opener.h"
#include "core/thinning/sweep_partners.h"
#include "core/thinning/thinning.h"
#include "core/thinning/thinning_state.h"
#include "core/thinning/work_list.h"

namespace bccskel {

// Bricks that a worker processes together, and its buffers for them.
struct SweepPart {
  exec::Share bricks = {0, 0};
  BrickLists to_do;
  BrickLists end_points_to_do;
  std::vector<MarkedBrick> ends;  // end points, judged as stubble or not
  MarkBuffer marks;               // of this pass

  bool empty() const { return bricks.begin == bricks.end; }
};

// One worker's bricks and buffers.
struct alignas(128) SweepWorker {
  exec::Share bricks = {0, 0};
  // Its bricks near others' below and above, and those between.
  std::array<SweepPart, 3> parts;
  // Where it is alone: see SweepShells(). Parts take turns at the slabs.
  std::vector<exec::Share> slabs;
  std::vector<SweepPart> slab_parts;
  ShellOpener opener;
  // Of partners' bricks below and above its own, whose points do not count here.
  std::array<ShellOpener, 2> ghost_openers;

  // Bricks of other workers that border on points removed here. Written while points are removed
  // and read by their owners before the next marks.
  std::vector<BrickIndex> seen_elsewhere;
  // Those beside a brick that fell asleep here. Written between cycles and read in the first pass.
  std::vector<BrickIndex> beside_sleepers_elsewhere;
  std::vector<MarkedBrick> ghost_marks;  // what its ghosts lose in this pass
  uint64_t removed = 0;
  std::array<uint64_t, 2> shell_points = {0, 0};  // by parity of the shell
};

// Makes the parts of a worker's bricks. Whether a point goes depends on points three steps away, so
// bricks with a layer of bricks between them and others' have nothing to do with those.
void SplitParts(const ThinningState& state, SweepWorker& worker);

// Makes slabs of all bricks, of which only those next to each other touch, and parts for passes of
// so many steps.
void SplitSlabs(const ThinningState& state, int steps, SweepWorker& worker);

// Marks the bricks that border on other workers'.
void MarkBorder(const ThinningState& state, const SweepWorker& worker, std::span<DirtyMask> dirty);

// Condition 6, for the end points that the rule found and those of bricks listed for them. End
// points that stay for good are no candidates from then on. Whether another one is a stubble point
// depends on points up to three steps away, so its brick stays dirty for end points.
void MarkStubble(StubblePolicy policy, ThinningState& state, std::span<DirtyMask> dirty,
                 SweepPart& part);

// Needs: `shells` outlive the worker; bricks outside of `own` are partners'.
void BeginOpening(const Shells& shells, exec::Share own, SweepWorker& worker);

// Sends all marks of a pass to partners. Needs: those of ghosts are gone.
void TellMarks(std::span<const SweepWorker> workers, SweepPartners& partners);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_
