#include "core/thinning/shell_sweep.h"

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

#include "core/exec/meeting_team.h"
#include "core/thinning/removal.h"
#include "core/thinning/sweep_worker.h"
#include "core/volume/count_points.h"

namespace bccskel {
namespace {

using Part = SweepPart;
using Worker = SweepWorker;

// A worker gets at least this many bricks divided by the rule's work, so that its part of a step
// takes longer than a barrier.
constexpr size_t kFewestBricks = 4 * kDirtyGroup;

class ShellSweep {
 public:
  ShellSweep(const SweepPlan& plan, PassRule& rule, const exec::Context& context,
             ThinningState& state)
      : shells_(plan.shells),
        last_(plan.last),
        done_(plan.done),
        stubble_(plan.stubble),
        after_shell_(plan.after_shell),
        partners_(plan.partners),
        own_(plan.partners == nullptr ? exec::Share{0, state.brick_count()} : plan.partners->own()),
        rule_(rule),
        context_(context),
        state_(state),
        watched_(plan.stubble == StubblePolicy::kNone ? kDirectionsDirty
                                                      : kDirectionsDirty | kEndPointsDirty),
        dirty_(groups() * kDirtyGroup),
        busy_groups_(groups()),
        enabled_(dirty_.size()),
        changed_(dirty_.size(), -1),
        team_(context.MeetingWorkersFor(state.brick_count(), rule.work()), context),
        workers_(static_cast<size_t>(team_.size())),
        shares_(state.brick_count(), team_.size()),
        points_at_start_(
            CountPoints(std::span(state.object).subspan(own_.begin, own_.end - own_.begin))) {
    for (Worker& worker : workers_) {
      worker.seen_elsewhere.resize(workers_.size());
      worker.beside_sleepers_elsewhere.resize(workers_.size());
    }
    for (BrickIndex n = 0; n < state.brick_count(); ++n) {
      if (state.SublatticeOf(n) == Sublattice::kOdd) dirty_[n] = kOddBrick;
      if (!sleeps()) dirty_[n] |= kBesideSleeper;
    }
  }

  absl::StatusOr<SweepTotals> Run() {
    if (partners_ != nullptr) partners_->Sum({&points_at_start_, 1});
    team_.Run([this](int index) { Work(index); });
    if (stopped_) return WhyStopped();
    return SweepTotals{TotalRemoved(), passes_};
  }

 private:
  absl::Status WhyStopped() const {
    const absl::Status own = context_.StopStatus();
    return own.ok() ? absl::CancelledError("a partner stopped the job") : own;
  }

  void Work(int index) {
    Worker& worker = workers_[static_cast<size_t>(index)];
    TakeShare(index, worker, 1);
    int32_t cycle = done_;  // each of those shells took one cycle
    for (int32_t shell = 1; shell <= done_; ++shell) OpenShell(worker, shell);
    for (int32_t shell = done_ + 1; shell <= last_; ++shell) {
      ShareAnew(index, worker, shell);
      OpenShell(worker, shell);
      uint64_t before = 0;
      do {
        before = TotalRemoved();
        for (int pass = 0; pass < rule_.passes_per_cycle(); ++pass) {
          if (!Pass(index, worker, {.shell = shell, .cycle = cycle, .pass = pass})) return;
        }
        team_.ConsiderParting(index);
        team_.Meet(index);  // the new object is complete, and so are the sums
        if (partners_ != nullptr && !Agree(index, shell)) return;
        if (sleeps()) FallAsleep(state_, shares_, changed_, cycle, dirty_, worker);
        ++cycle;
        // The last shell may have thousands of cycles.
        if (team_.parting() && !JoinedInOne(index, worker)) return;
      } while (shell == last_ && TotalRemoved() != before);
      if (index == 0) Report(shell);
      if (after_shell_) team_.Meet(index);
    }
  }

  void TakeShare(int index, Worker& worker, int32_t shell) {
    worker.bricks = shares_.Of(index);
    BeginOpening(shells_, shell, own_, worker);
    SplitBricks(state_, rule_.steps(), !slabs_run_ahead(), worker);
    if (team_.meets(index)) FindBorder(state_, shares_, worker, dirty_);
  }

  // Before a shell is opened: moves the ranges of bricks if the next shells would be shared
  // unevenly. With several passes per cycle each removes points on one side of the object only, so
  // workers that have equal parts of a shell do not have equal parts of a pass.
  void ShareAnew(int index, Worker& worker, int32_t shell) {
    if (!team_.meets(index) || sleeps() || shell % kShellsAtOnce != 0) return;
    shares_.Count(index, shells_, shell);
    team_.Meet(index);
    const size_t fewest = kFewestBricks / rule_.work();
    if (!shares_.Uneven(fewest)) return;
    HearOfChanges(index, worker);
    shares_.Cut(index, shells_, shell, fewest);
    team_.Meet(index);
    if (index == 0) shares_.Adopt();
    Clear(worker.seen_elsewhere);
    team_.Meet(index);
    TakeShare(index, worker, shell);
  }

  // Returns whether this worker continues; worker 0 takes over from the others, once.
  bool JoinedInOne(int index, Worker& first) {
    team_.Meet(index);  // the others have left their bricks
    if (index != 0) return false;
    if (!team_.meets(0)) return true;
    team_.GoOnAlone();
    for (Worker& worker : workers_) MarkDirty(std::exchange(worker.seen_elsewhere, {}));
    for (Worker& other : std::span(workers_).subspan(1)) TakeOver(other, first);
    shares_.JoinInOne();
    first.bricks = shares_.Of(0);
    first.adjacent.clear();
    SplitBricks(state_, rule_.steps(), !slabs_run_ahead(), first);
    for (DirtyMask& brick : dirty_) {
      if ((brick & kBorderBrick) == 0) continue;
      brick = static_cast<DirtyMask>((brick & ~kBorderBrick) | kBesideSleeper);
    }
    return true;
  }

  void TakeOver(Worker& other, Worker& first) {
    first.opener.TakeOver(other.opener);
    for (size_t n = 0; n < 2; ++n) {
      first.ghost_openers[n].TakeOver(other.ghost_openers[n]);
      first.shell_points[n] += other.shell_points[n];
    }
    Worker nothing_to_do;
    nothing_to_do.removed = other.removed;
    other = std::move(nothing_to_do);
  }

  void MarkDirty(const BricksByOwner& seen) {
    for (const std::vector<BrickIndex>& bricks : seen) MarkDirty(bricks);
  }
  void MarkDirty(std::span<const BrickIndex> bricks) {
    for (const BrickIndex n : bricks) DirtyView().Add(n, enabled_[n]);
  }

  // Condition 5: the points of this shell become candidates.
  void OpenShell(Worker& worker, int32_t shell) {
    const OpeningView view = {
        .object = state_.object.data(),
        .kept = state_.kept.empty() ? nullptr : state_.kept.data(),
        .candidates = state_.candidates.data(),
        .dirty = DirtyView(),
        .enabled = enabled_.data(),
        .watched = watched_,
        .woken = static_cast<DirtyMask>(watched_ | (sleeps() ? kAwake : 0)),
    };
    worker.shell_points[static_cast<size_t>(shell & 1)] = worker.opener.Open(view, shell);
    if (partners_ == nullptr) return;
    for (ShellOpener& opener : worker.ghost_openers) opener.Open(view, shell);
  }

  // With a single pass per cycle nothing is gained from visiting bricks that did not change.
  bool sleeps() const { return rule_.passes_per_cycle() > 1; }

  // Whether slabs take steps before the borders have taken theirs. Partners need all marks of a
  // pass at once, and so do bricks that fall asleep.
  bool slabs_run_ahead() const { return !sleeps() && partners_ == nullptr; }

  DirtyBricks DirtyView() { return {dirty_.data(), busy_groups_.data()}; }

  // One more than the full groups, so that there is room for the padding brick.
  size_t groups() const { return state_.brick_count() / kDirtyGroup + 1; }

  // One pass. Returns false when the job was stopped; all workers return the same.
  bool Pass(int index, Worker& worker, PassStep at) {
    team_.Await(index);  // others have removed their points near here
    if (index == 0) {
      if (partners_ == nullptr) stopped_ = context_.ShouldStop();
      ++passes_;
    }
    if (!team_.meets(index) && stopped_) return false;
    HearOfChanges(index, worker);
    for (; at.step < rule_.steps(); ++at.step) {
      if (at.step > 0) team_.Await(index);  // others have finished the previous step
      Step(index, at, worker);
    }
    team_.Await(index);  // no worker reads points near its border any more
    if (stopped_) return false;
    if (at.pass == 0) HearOfSleepers(workers_, index, dirty_);
    Clear(worker.seen_elsewhere);
    if (partners_ != nullptr) TradeMarks(index, at.cycle, worker);
    Step(index, at, worker);
    return true;
  }

  // A step of a pass, the last of which removes points. Processes the bricks that border on others'
  // first and then signals; while this worker processes the rest, others learn that they are done,
  // so that hardly any worker has to wait. After the first step of the borders, slabs take further
  // ones.
  void Step(int index, const PassStep& at, Worker& worker) {
    if (index == 0) context_.Yield();
    for (Part& border : worker.borders) {
      if (!border.empty()) Take(at, border, worker);
    }
    team_.Arrive(index);
    if (at.step == 0) return RunAhead(index, at, worker);
    for (size_t slab = 0; slab < worker.slabs.size(); ++slab) {
      if (at.step <= ReachOf(slab, worker)) continue;
      if (index == 0) context_.Yield();
      Take(at, worker.PartOf(slab, rule_.steps()), worker);
    }
  }

  int ReachOf(size_t slab, const Worker& worker) const {
    return slabs_run_ahead() ? worker.ReachOf(slab, rule_.steps()) : 0;
  }

  // While a slab is at its first step, each slab before it is one step further, so that all data of
  // a pass stay in near caches.
  void RunAhead(int index, PassStep at, Worker& worker) {
    const size_t count = worker.slabs.size(), steps = static_cast<size_t>(rule_.steps());
    for (size_t n = 0; n < count + steps; ++n) {
      if (index == 0) context_.Yield();
      for (size_t step = n < count ? 0 : n - count + 1; step <= std::min(n, steps); ++step) {
        const size_t slab = n - step;
        at.step = static_cast<int>(step);
        if (at.step > ReachOf(slab, worker)) continue;
        // No points are removed before all workers have left the last cycle.
        if (step == steps) team_.Await(index);
        Part& part = worker.PartOf(slab, rule_.steps());
        part.bricks = worker.slabs[slab];  // parts take turns
        Take(at, part, worker);
      }
    }
  }

  void Take(const PassStep& at, Part& part, Worker& worker) {
    if (at.step < rule_.steps()) {
      Mark(at, part);
    } else {
      Remove(at.cycle, part, worker);
    }
  }

  // The owners of ghosts know which points these lose.
  void TradeMarks(int index, int32_t cycle, Worker& worker) {
    worker.ForEachPart([&](Part& part) {
      part.marks.Filter([this](const MarkedBrick& m) { return IsOwnOrMarkDirty(m.brick); });
    });
    team_.Meet(index);
    if (index == 0) {
      TellMarks(workers_, *partners_);
      lost_by_ghosts_ = partners_->Hear();
    }
    team_.Meet(index);
    worker.ghost_marks.clear();
    for (const MarkedBrick& m : lost_by_ghosts_) {
      if (worker.Owns(m.brick)) worker.ghost_marks.push_back(m);
    }
    RemoveMarked(ViewFor(cycle, worker), worker.ghost_marks, worker.seen_elsewhere);
  }

  // A ghost whose marks are dropped still has simple points, so it must be visited again.
  bool IsOwnOrMarkDirty(BrickIndex n) {
    if (n >= own_.begin && n < own_.end) return true;
    DirtyView().Add(n, enabled_[n]);
    return false;
  }

  // Returns whether all continue; the sums are then those of all partners.
  bool Agree(int index, int32_t shell) {
    if (index == 0) {
      std::array<uint64_t, 3> sums = {RemovedHere(), ShellPointsHere(shell),
                                      context_.ShouldStop() ? 1u : 0u};
      partners_->Sum(sums);
      all_removed_ = sums[0];
      all_shell_points_ = sums[1];
      stopped_ = sums[2] != 0;
    }
    team_.Meet(index);
    return !stopped_;
  }

  void Mark(const PassStep& at, Part& part) {
    if (at.step == 0) {
      part.marks.Clear();
      part.ends.clear();
      TakeDirty(DirtyView(), part.bricks.begin, part.bricks.end, rule_.BitsToVisit(at), part.to_do,
                part.end_points_to_do);
    }
    rule_.Mark(at, part.to_do, dirty_.data(), part.marks, part.ends);
    if (at.step + 1 == rule_.steps()) MarkStubble(stubble_, state_, dirty_, part);
  }

  // Bricks of this worker next to which others removed points in the last pass.
  void HearOfChanges(int index, const Worker& worker) {
    for (const int other : worker.adjacent) {
      const Worker& from = workers_[static_cast<size_t>(other)];
      MarkDirty(from.seen_elsewhere[static_cast<size_t>(index)]);
    }
  }

  void Remove(int32_t cycle, Part& part, Worker& worker) {
    rule_.Finish(part.to_do);
    worker.removed +=
        RemoveMarked(ViewFor(cycle, worker), part.marks.marked(), worker.seen_elsewhere);
  }

  RemovalView ViewFor(int32_t cycle, const Worker& worker) {
    return {.object = state_.object.data(),
            .candidates = state_.candidates.data(),
            .neighbors = state_.neighbors.data(),
            .dirty = DirtyView(),
            .enabled = enabled_.data(),
            .changed = changed_.data(),
            .cycle = cycle,
            .first = static_cast<BrickIndex>(worker.bricks.begin),
            .last = static_cast<BrickIndex>(worker.bricks.end),
            .none = static_cast<BrickIndex>(state_.brick_count()),
            .owners = shares_.owners()};
  }

  // Needs: called between the second meeting of a pass and the first of the next, when no worker
  // removes anything.
  uint64_t TotalRemoved() const { return partners_ == nullptr ? RemovedHere() : all_removed_; }
  uint64_t RemovedHere() const {
    uint64_t total = 0;
    for (const Worker& worker : workers_) total += worker.removed;
    return total;
  }

  uint64_t ShellPointsHere(int32_t shell) const {
    uint64_t points = 0;
    for (const Worker& worker : workers_) {
      points += worker.shell_points[static_cast<size_t>(shell & 1)];
    }
    return points;
  }

  void Report(int32_t shell) const {
    const uint64_t points = partners_ == nullptr ? ShellPointsHere(shell) : all_shell_points_;
    const uint64_t removed = TotalRemoved();
    context_.Report({.shell = shell,
                     .last_shell = shells_.last(),
                     .points = points,
                     .removed = removed,
                     .remaining = points_at_start_ - removed});
    if (after_shell_) after_shell_(shell);
  }

  const Shells& shells_;
  const int32_t last_;
  const int32_t done_;
  const StubblePolicy stubble_;
  const std::function<void(int32_t)>& after_shell_;
  SweepPartners* const partners_;
  const exec::Share own_;  // the other bricks are ghosts
  PassRule& rule_;
  const exec::Context& context_;
  ThinningState& state_;
  const DirtyMask watched_;
  std::vector<DirtyMask> dirty_;
  std::vector<uint8_t> busy_groups_;  // as in DirtyBricks
  std::vector<DirtyMask> enabled_;    // watched_ once the brick has candidates, before that 0
  std::vector<int32_t> changed_;      // the cycle in which a brick last lost points
  exec::MeetingTeam team_;
  std::vector<Worker> workers_;
  BrickShares shares_;
  uint64_t points_at_start_;
  uint32_t passes_ = 0;   // written by worker 0
  bool stopped_ = false;  // written by worker 0 before the first meeting of a pass

  // Of all partners; written by worker 0 between the meetings of Agree() and TradeMarks().
  uint64_t all_removed_ = 0;
  uint64_t all_shell_points_ = 0;
  std::span<const MarkedBrick> lost_by_ghosts_;
};

}  // namespace

absl::StatusOr<SweepTotals> SweepShells(const SweepPlan& plan, PassRule& rule,
                                        const exec::Context& context, ThinningState& state) {
  return ShellSweep(plan, rule, context, state).Run();
}

}  // namespace bccskel
