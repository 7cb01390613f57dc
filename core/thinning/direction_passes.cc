#include "core/thinning/direction_passes.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>
#include <vector>

#include "core/thinning/stubble.h"

namespace bccskel {
namespace {

// What may have to be looked at again in a brick: bit d for direction d, and the end points.
using Unsettled = uint16_t;
constexpr Unsettled kEndPointsUnsettled = 1 << 8;
constexpr Unsettled kDirectionsUnsettled = kEndPointsUnsettled - 1;

// For a set of axes, all its subsets: bit s of the result stands for the subset s.
constexpr std::array<uint32_t, 8> kSubsetsOf = [] {
  std::array<uint32_t, 8> subsets = {};
  for (uint32_t axes = 0; axes < 8; ++axes) {
    for (uint32_t s = 0; s < 8; ++s) {
      if ((s & ~axes) == 0) subsets[axes] |= 1u << s;
    }
  }
  return subsets;
}();

// The neighboring bricks (positions of BrickNeighborhood) that hold neighbors of removed points.
uint32_t BricksThatSee(const BrickBits& removed, Sublattice sublattice) {
  uint64_t any = 0;
  for (uint64_t word : removed.words) any |= word;
  const uint32_t low = ((any & 0x0001000100010001) != 0 ? 1u : 0u) |
                       ((any & 0xffff) != 0 ? 2u : 0u) | (removed.words[0] != 0 ? 4u : 0u);
  const uint32_t high = ((any & 0x8000800080008000) != 0 ? 1u : 0u) | ((any >> 48) != 0 ? 2u : 0u) |
                        (removed.words[7] != 0 ? 4u : 0u);
  const uint32_t axial = (high & 1) << 8 | (low & 1) << 9 | (high & 2) << 9 | (low & 2) << 10 |
                         (high & 4) << 10 | (low & 4) << 11;
  return kSubsetsOf[sublattice == Sublattice::kEven ? low : high] | axial;
}

// One worker's bricks and buffers.
struct alignas(64) Worker {
  exec::Share bricks = {0, 0};
  std::vector<BrickIndex> by_first_shell;  // own bricks in the order in which shells reach them
  size_t reached = 0;                      // how many of them have been reached
  std::vector<BrickIndex> opening;         // reached, and deeper points still to come

  std::array<std::vector<BrickIndex>, 2> directions_to_do;  // by sublattice
  std::array<std::vector<BrickIndex>, 2> end_points_to_do;
  std::vector<BrickIndex> border;
  std::vector<MarkedBrick> marked;

  // Bricks of other workers that border on points removed here. Written in one pass and read by
  // their owners in the next, hence two.
  std::array<std::vector<BrickIndex>, 2> seen_elsewhere;
  size_t parity = 0;  // of the pass
  uint64_t removed = 0;
  std::array<uint64_t, 2> shell_points = {0, 0};  // by parity of the shell
};

class DirectionPasses {
 public:
  DirectionPasses(const Shells& shells, int32_t last, StubblePolicy stubble,
                  const exec::Context& context, ThinningState& state)
      : shells_(shells),
        last_(last),
        stubble_(stubble),
        context_(context),
        state_(state),
        watched_(stubble == StubblePolicy::kNone ? kDirectionsUnsettled
                                                 : kDirectionsUnsettled | kEndPointsUnsettled),
        unsettled_(state.brick_count()),
        enabled_(state.brick_count()),
        workers_(static_cast<size_t>(context.WorkersFor(state.brick_count()))),
        barrier_(static_cast<int>(workers_.size())) {
    for (const BrickBits& brick : state.object) points_at_start_ += brick.Count();
  }

  absl::StatusOr<DirectionPassTotals> Run() {
    context_.Run([this](int index) {
      if (static_cast<size_t>(index) < workers_.size()) Work(index);
    });
    if (stopped_) return context_.StopStatus();
    return DirectionPassTotals{TotalRemoved(), passes_};
  }

 private:
  void Work(int index) {
    Worker& worker = workers_[static_cast<size_t>(index)];
    Prepare(index, worker);
    for (int32_t shell = 1; shell <= last_; ++shell) {
      OpenShell(worker, shell);
      uint64_t before = 0;
      do {
        before = TotalRemoved();
        for (int d = 0; d < 8; ++d) {
          if (!Pass(index, worker, DiagonalDirection(d))) return;
        }
      } while (shell == last_ && TotalRemoved() != before);
      if (index == 0) Report(shell);
    }
  }

  void Prepare(int index, Worker& worker) {
    worker.bricks = exec::ShareOf(state_.brick_count(), index, static_cast<int>(workers_.size()));
    const size_t count = worker.bricks.end - worker.bricks.begin;
    worker.by_first_shell.resize(count);
    std::iota(worker.by_first_shell.begin(), worker.by_first_shell.end(),
              static_cast<BrickIndex>(worker.bricks.begin));
    std::ranges::stable_sort(worker.by_first_shell, {},
                             [this](BrickIndex n) { return shells_.RangeOf(n).first; });
    for (auto* lists : {&worker.directions_to_do, &worker.end_points_to_do}) {
      for (std::vector<BrickIndex>& list : *lists) list.reserve(count);
    }
    worker.border.resize(count);
  }

  // Condition 5: the points of this shell become candidates.
  void OpenShell(Worker& worker, int32_t shell) {
    while (worker.reached < worker.by_first_shell.size() &&
           shells_.RangeOf(worker.by_first_shell[worker.reached]).first <= shell) {
      worker.opening.push_back(worker.by_first_shell[worker.reached++]);
    }
    uint64_t points = 0;
    std::erase_if(worker.opening, [&](BrickIndex n) {
      points += OpenBrick(n, shell);
      return shells_.RangeOf(n).last == shell;
    });
    worker.shell_points[static_cast<size_t>(shell & 1)] = points;
  }

  uint64_t OpenBrick(BrickIndex n, int32_t shell) {
    BrickBits opened = shells_.PointsIn(n, shell);
    for (size_t k = 0; k < opened.words.size(); ++k) {
      opened.words[k] &= state_.object[n].words[k];
      if (!state_.kept.empty()) opened.words[k] &= ~state_.kept[n].words[k];
      state_.candidates[n].words[k] |= opened.words[k];
    }
    const uint64_t points = opened.Count();
    if (points != 0) unsettled_[n] = enabled_[n] = watched_;
    return points;
  }

  // One pass along d. Returns false when the job was stopped; all workers return the same.
  bool Pass(int index, Worker& worker, DiagonalDirection d) {
    if (index == 0) {
      stopped_ = context_.ShouldStop();
      ++passes_;
    }
    TakeOverUnsettled(worker);
    worker.marked.clear();
    ListUnsettled(worker, d);
    MarkDirection(worker, d);
    MarkStubble(worker);
    barrier_.Wait();  // nobody reads the old object any more
    if (stopped_) return false;
    RemoveMarked(worker);
    barrier_.Wait();  // the new object is complete
    worker.parity ^= 1;
    return true;
  }

  // Bricks of this worker next to which others removed points in the last pass.
  void TakeOverUnsettled(const Worker& worker) {
    for (const Worker& other : workers_) {
      for (BrickIndex n : other.seen_elsewhere[worker.parity ^ 1]) {
        if (Owns(worker, n)) unsettled_[n] |= enabled_[n];
      }
    }
  }

  // A listed brick counts as settled; removing points from it or beside it unsettles it again.
  void ListUnsettled(Worker& worker, DiagonalDirection d) {
    for (auto* lists : {&worker.directions_to_do, &worker.end_points_to_do}) {
      for (std::vector<BrickIndex>& list : *lists) list.clear();
    }
    const auto along_d = static_cast<Unsettled>(1u << d.bit());
    for (size_t n = worker.bricks.begin; n < worker.bricks.end; ++n) {
      const Unsettled unsettled = unsettled_[n];
      if ((unsettled & (along_d | kEndPointsUnsettled)) == 0) continue;
      const auto brick = static_cast<BrickIndex>(n);
      const auto sublattice = static_cast<size_t>(state_.SublatticeOf(brick));
      if ((unsettled & along_d) != 0) worker.directions_to_do[sublattice].push_back(brick);
      if ((unsettled & kEndPointsUnsettled) != 0) {
        worker.end_points_to_do[sublattice].push_back(brick);
      }
      unsettled_[n] = static_cast<Unsettled>(unsettled & ~(along_d | kEndPointsUnsettled));
    }
  }

  void MarkDirection(Worker& worker, DiagonalDirection d) {
    const ObjectView view = state_.View();
    for (Sublattice sublattice : kSublattices) {
      const std::vector<BrickIndex>& bricks =
          worker.directions_to_do[static_cast<size_t>(sublattice)];
      const size_t border = KeepBorderBricks(view, sublattice, d, bricks, worker.border.data());
      const size_t marked = worker.marked.size();
      worker.marked.resize(marked + border);
      worker.marked.resize(marked + MarkRemovable(view, sublattice, d,
                                                  std::span(worker.border).first(border),
                                                  worker.marked.data() + marked));
    }
  }

  // Whether an end point is a stubble point depends on points up to three steps away, so a brick
  // with end points stays unsettled for them.
  void MarkStubble(Worker& worker) {
    for (Sublattice sublattice : kSublattices) {
      const std::vector<BrickIndex>& bricks =
          worker.end_points_to_do[static_cast<size_t>(sublattice)];
      const size_t first = worker.marked.size();
      worker.marked.resize(first + bricks.size());
      worker.marked.resize(
          first + MarkEndPoints(state_.View(), sublattice, bricks, worker.marked.data() + first));
      for (size_t m = first; m < worker.marked.size(); ++m) {
        MarkedBrick& marked = worker.marked[m];
        unsettled_[marked.brick] |= kEndPointsUnsettled;
        marked.marks = SelectStubble(state_, marked, stubble_);
      }
    }
  }

  void RemoveMarked(Worker& worker) {
    worker.seen_elsewhere[worker.parity].clear();
    for (const MarkedBrick& marked : worker.marked) {
      const uint64_t count = marked.marks.Count();
      if (count == 0) continue;
      worker.removed += count;
      BrickBits& object = state_.object[marked.brick];
      for (size_t k = 0; k < object.words.size(); ++k) object.words[k] &= ~marked.marks.words[k];
      Unsettle(worker, marked.brick, marked.marks);
    }
  }

  void Unsettle(Worker& worker, BrickIndex brick, const BrickBits& removed) {
    unsettled_[brick] |= enabled_[brick];
    const BrickNeighborhood& neighbors = state_.neighbors[brick];
    for (uint32_t left = BricksThatSee(removed, state_.SublatticeOf(brick)); left != 0;
         left &= left - 1) {
      const BrickIndex n = neighbors[static_cast<size_t>(std::countr_zero(left))];
      if (Owns(worker, n)) {
        unsettled_[n] |= enabled_[n];
      } else if (n != state_.brick_count()) {
        worker.seen_elsewhere[worker.parity].push_back(n);
      }
    }
  }

  static bool Owns(const Worker& worker, BrickIndex n) {
    return n >= worker.bricks.begin && n < worker.bricks.end;
  }

  // Needs: called between the second meeting of a pass and the first of the next, when no worker
  // removes anything.
  uint64_t TotalRemoved() const {
    uint64_t total = 0;
    for (const Worker& worker : workers_) total += worker.removed;
    return total;
  }

  void Report(int32_t shell) const {
    uint64_t points = 0;
    for (const Worker& worker : workers_) {
      points += worker.shell_points[static_cast<size_t>(shell & 1)];
    }
    const uint64_t removed = TotalRemoved();
    context_.Report({.shell = shell,
                     .last_shell = shells_.last(),
                     .points = points,
                     .removed = removed,
                     .remaining = points_at_start_ - removed});
  }

  const Shells& shells_;
  const int32_t last_;
  const StubblePolicy stubble_;
  const exec::Context& context_;
  ThinningState& state_;
  const Unsettled watched_;
  std::vector<Unsettled> unsettled_;
  std::vector<Unsettled> enabled_;  // watched_ once the brick has candidates, before that 0
  std::vector<Worker> workers_;
  exec::Barrier barrier_;
  uint64_t points_at_start_ = 0;
  uint32_t passes_ = 0;   // written by worker 0
  bool stopped_ = false;  // written by worker 0 before the first meeting of a pass
};

}  // namespace

absl::StatusOr<DirectionPassTotals> RunDirectionPasses(const Shells& shells, int32_t last,
                                                       StubblePolicy stubble,
                                                       const exec::Context& context,
                                                       ThinningState& state) {
  return DirectionPasses(shells, last, stubble, context, state).Run();
}

}  // namespace bccskel
