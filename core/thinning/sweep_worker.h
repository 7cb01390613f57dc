#ifndef BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_
#define BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/exec/worker_team.h"
#include "core/thinning/brick_shares.h"
#include "core/thinning/pass_rule.h"
#include "core/thinning/removal.h"
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
  MarkBuffer marks;               // of the current pass

  bool empty() const { return bricks.begin == bricks.end; }
};

// One worker's bricks and buffers.
struct alignas(128) SweepWorker {
  exec::Share bricks = {0, 0};
  // Its bricks near those of others, below and above.
  std::array<SweepPart, 2> borders;
  // The bricks between. Each slab touches only the one before and the one after it, and only the
  // first and the last one touch borders.
  std::vector<exec::Share> slabs;
  std::vector<SweepPart> slab_parts;
  ShellOpener opener;
  // For partners' bricks below and above its own, whose points are not counted here.
  std::array<ShellOpener, 2> ghost_openers;

  // The workers that own bricks next to its own.
  std::vector<int> adjacent;
  // Bricks of other workers, by owner, that border on points removed here. Written while points are
  // removed and read by their owners before the next marks.
  BricksByOwner seen_elsewhere;
  // Those beside a brick that fell asleep here. Written between cycles and read in the first pass.
  BricksByOwner beside_sleepers_elsewhere;
  std::vector<MarkedBrick> ghost_marks;  // what its ghosts lose in this pass
  uint64_t removed = 0;
  std::array<uint64_t, 2> shell_points = {0, 0};  // by parity of the shell

  bool Owns(BrickIndex n) const { return n >= bricks.begin && n < bricks.end; }
  // Slabs near a border, which wait for its steps, have parts of their own; the others, of which
  // one after another completes the pass, take turns.
  SweepPart& PartOf(size_t slab, int steps);
  // The steps that a slab can take once the borders have taken their first; they take each of the
  // others after all workers have met. A step of a slab reads what the previous step left in the
  // adjacent slabs, and their points, which they remove later.
  int ReachOf(size_t slab, int steps) const;
  // Calls visit(SweepPart&) for all parts.
  template <typename Visit>
  void ForEachPart(Visit visit) {
    for (SweepPart& part : borders) visit(part);
    for (SweepPart& part : slab_parts) visit(part);
  }
  template <typename Visit>
  void ForEachPart(Visit visit) const {
    for (const SweepPart& part : borders) visit(part);
    for (const SweepPart& part : slab_parts) visit(part);
  }
};

// Splits a worker's bricks into borders and slabs, and creates parts for passes of `steps` steps.
// Whether a point is removed depends on points up to three steps away, so bricks that are separated
// from those of others by a layer of bricks do not depend on them.
// `one_slab`: all bricks between the borders, and thus all marks of a pass, in one part.
void SplitBricks(const ThinningState& state, int steps, bool one_slab, SweepWorker& worker);

// Marks the bricks that border on those of other workers and lists these workers. Bricks that no
// longer border on any stay marked, which only costs time.
// Needs: SplitBricks() was called.
void FindBorder(const ThinningState& state, const BrickShares& shares, SweepWorker& worker,
                std::span<DirtyMask> dirty);

// Puts bricks to sleep around which nothing changed in this cycle: they were visited in all of its
// passes, so they are settled. `changed` is the last cycle in which a brick changed.
// Needs: the last pass listed all bricks that are awake; the worker has one slab.
void FallAsleep(const ThinningState& state, const BrickShares& shares,
                std::span<const int32_t> changed, int32_t cycle, std::span<DirtyMask> dirty,
                SweepWorker& worker);

// Takes over what adjacent workers know of sleeping bricks beside those of worker `index`.
void HearOfSleepers(std::span<const SweepWorker> workers, int index, std::span<DirtyMask> dirty);

void Clear(BricksByOwner& bricks);

// Applies Condition 6 to the end points that the rule found and those of bricks listed for them.
// End points that stay for good are no longer candidates. Whether another one is a stubble point
// depends on points up to three steps away, so its brick stays dirty for end points.
void MarkStubble(StubblePolicy policy, ThinningState& state, std::span<DirtyMask> dirty,
                 SweepPart& part);

// Before `shell` is opened. Needs: `shells` outlive the worker; bricks outside `own` belong to
// partners.
void BeginOpening(const Shells& shells, int32_t shell, exec::Share own, SweepWorker& worker);

// Sends all marks of a pass to partners. Needs: marks of ghosts have been removed.
void TellMarks(std::span<const SweepWorker> workers, SweepPartners& partners);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_SWEEP_WORKER_H_
