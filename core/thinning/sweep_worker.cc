#include "core/thinning/sweep_worker.h"

#include <algorithm>
#include <bit>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

size_t RoundUp(size_t n) { return (n + kDirtyGroup - 1) / kDirtyGroup * kDirtyGroup; }

int32_t LayerOf(const ThinningState& state, size_t brick) {
  return state.keys[brick].coordinates().bz;
}

size_t FirstFromLayer(const ThinningState& state, int32_t layer) {
  const auto first = std::ranges::lower_bound(state.keys, layer, {},
                                              [](BrickKey key) { return key.coordinates().bz; });
  return static_cast<size_t>(first - state.keys.begin());
}

// The number of slabs at a border that cannot complete a pass before the border does: the first one
// may be one step ahead of the border, the second two steps, and so on.
size_t WaitingSlabs(int steps) { return static_cast<size_t>(std::max(steps - 1, 0)); }

// So many slabs are in work at a time.
size_t TurnsOf(int steps) { return static_cast<size_t>(steps) + 1; }

// Each slab begins in the first layer that the one before the last slab does not touch.
void AddSlabs(const ThinningState& state, exec::Share bricks, std::vector<exec::Share>& slabs) {
  for (size_t begin = bricks.begin; begin < bricks.end;) {
    const int32_t below = LayerOf(state, begin) - 1;  // maybe a layer without bricks
    const int32_t touched = begin == 0 ? below : std::max(below, LayerOf(state, begin - 1));
    const size_t next = std::min(RoundUp(FirstFromLayer(state, touched + 2)), bricks.end);
    slabs.push_back({begin, next});
    begin = next;
  }
  // The border above must not touch the last slab but one.
  if (slabs.size() < 2 || bricks.end == state.brick_count()) return;
  const exec::Share last = slabs.back();
  if (LayerOf(state, last.begin - 1) + 2 <= LayerOf(state, last.end)) return;
  slabs.pop_back();
  slabs.back().end = last.end;
}

// For other bricks than before: an empty part, which no pass visits, must not keep its old lists.
void Begin(exec::Share bricks, SweepPart& part) {
  part.bricks = bricks;
  for (BrickLists* lists : {&part.to_do, &part.end_points_to_do}) {
    lists->Reserve(bricks.end - bricks.begin);
    lists->SetCounts(0, 0);
  }
  part.ends.clear();
  part.marks.Clear();
}

// The number of end points among the neighbors of a point that come before direction `before`.
int EndPointsBefore(const ThinningState& state, const NeighborAddress& q, NeighborMask neighbors,
                    Direction before) {
  int count = 0;
  ForEachDirection(static_cast<NeighborMask>(neighbors & (before.mask() - 1)), [&](Direction d) {
    const NeighborAddress e = NeighborAt(state, q.brick, q.bit, d);
    if (IsEndPoint(state.NeighborsOf(e.brick, e.bit))) ++count;
  });
  return count;
}

enum class EndKind : uint8_t {
  // No pass will remove it: rules remove end points only as stubble, and the neighbor has at most
  // two neighbors and gets no more.
  kStays,
  // Condition 6. The neighbor of a stubble point is never removed in the same pass: it is neither
  // an end point nor simple. So the topology stays.
  kStubble,
  kKept,
};

// Needs: the point is an end point.
EndKind Judge(const ThinningState& state, BrickIndex brick, int bit, StubblePolicy policy) {
  const Direction to_neighbor(std::countr_zero(state.NeighborsOf(brick, bit)));
  const NeighborAddress q = NeighborAt(state, brick, bit, to_neighbor);
  const NeighborMask around_q = state.NeighborsOf(q.brick, q.bit);
  const int neighbors = NeighborsIn(around_q);
  if (neighbors <= 2) return EndKind::kStays;
  if (policy == StubblePolicy::kLiteral) return EndKind::kStubble;
  const int before = EndPointsBefore(state, q, around_q, to_neighbor.Opposite());
  return before < neighbors - 2 ? EndKind::kStubble : EndKind::kKept;
}

void PutToSleep(const ThinningState& state, const BrickShares& shares, BrickIndex n,
                std::span<DirtyMask> dirty, SweepWorker& worker) {
  dirty[n] &= static_cast<DirtyMask>(~(kAwake | kDirectionsDirty));
  for (const BrickIndex near : state.neighbors[n]) {
    if (worker.Owns(near)) {
      dirty[near] |= kBesideSleeper;
    } else if (near < state.brick_count()) {
      worker.beside_sleepers_elsewhere[static_cast<size_t>(shares.OwnerOf(near))].push_back(near);
    }
  }
}

}  // namespace

void FallAsleep(const ThinningState& state, const BrickShares& shares,
                std::span<const int32_t> changed, int32_t cycle, std::span<DirtyMask> dirty,
                SweepWorker& worker) {
  Clear(worker.beside_sleepers_elsewhere);
  const auto has_changed = [&](BrickIndex brick) { return changed[brick] == cycle; };
  worker.ForEachPart([&](const SweepPart& part) {
    for (Sublattice sublattice : kSublattices) {
      for (const BrickIndex n : part.to_do.Of(sublattice)) {
        if ((dirty[n] & kAwake) == 0 || has_changed(n)) continue;
        if (std::ranges::any_of(state.neighbors[n], has_changed)) continue;
        PutToSleep(state, shares, n, dirty, worker);
      }
    }
  });
}

void HearOfSleepers(std::span<const SweepWorker> workers, int index, std::span<DirtyMask> dirty) {
  const auto own = static_cast<size_t>(index);
  for (const int other : workers[own].adjacent) {
    const SweepWorker& from = workers[static_cast<size_t>(other)];
    for (const BrickIndex n : from.beside_sleepers_elsewhere[own]) dirty[n] |= kBesideSleeper;
  }
}

void Clear(BricksByOwner& bricks) {
  for (std::vector<BrickIndex>& list : bricks) list.clear();
}

void SplitBricks(const ThinningState& state, int steps, bool one_slab, SweepWorker& worker) {
  const auto [begin, end] = worker.bricks;
  size_t low = begin, high = end;
  if (begin > 0 && begin < end) {
    low = std::clamp(RoundUp(FirstFromLayer(state, LayerOf(state, begin - 1) + 2)), begin, end);
  }
  if (begin < end && end < state.brick_count()) {
    high = FirstFromLayer(state, LayerOf(state, end) - 1) / kDirtyGroup * kDirtyGroup;
    high = std::clamp(high, low, end);
  }
  Begin({begin, low}, worker.borders[0]);
  Begin({high, end}, worker.borders[1]);
  worker.slabs.clear();
  if (one_slab && low < high) {
    worker.slabs.push_back({low, high});
  } else {
    AddSlabs(state, {low, high}, worker.slabs);
  }
  const size_t parts = 2 * WaitingSlabs(steps) + TurnsOf(steps);
  worker.slab_parts.resize(std::min(worker.slabs.size(), parts));
  for (size_t slab = 0; slab < worker.slabs.size(); ++slab) {
    Begin(worker.slabs[slab], worker.PartOf(slab, steps));
  }
}

SweepPart& SweepWorker::PartOf(size_t slab, int steps) {
  const size_t waiting = WaitingSlabs(steps), after = slabs.size() - 1 - slab;
  if (slab_parts.size() == slabs.size() || slab < waiting) return slab_parts[slab];
  if (after < waiting) return slab_parts[waiting + after];
  return slab_parts[2 * waiting + slab % TurnsOf(steps)];
}

int SweepWorker::ReachOf(size_t slab, int steps) const {
  size_t reach = static_cast<size_t>(steps);
  if (!borders[0].empty()) reach = std::min(reach, slab + 1);
  if (!borders[1].empty()) reach = std::min(reach, slabs.size() - slab);
  return static_cast<int>(reach);
}

void FindBorder(const ThinningState& state, const BrickShares& shares, SweepWorker& worker,
                std::span<DirtyMask> dirty) {
  const exec::Share own = worker.bricks;
  worker.adjacent.clear();
  for (const SweepPart& part : worker.borders) {
    for (size_t n = part.bricks.begin; n < part.bricks.end; ++n) {
      dirty[n] &= static_cast<DirtyMask>(~kBorderBrick);
      for (const BrickIndex other : state.neighbors[n]) {
        if (other >= state.brick_count() || (other >= own.begin && other < own.end)) continue;
        dirty[n] |= kBorderBrick;
        const int owner = shares.OwnerOf(other);
        if (std::ranges::find(worker.adjacent, owner) == worker.adjacent.end()) {
          worker.adjacent.push_back(owner);
        }
      }
    }
  }
}

void MarkStubble(StubblePolicy policy, ThinningState& state, std::span<DirtyMask> dirty,
                 SweepPart& part) {
  if (policy == StubblePolicy::kNone) return;
  const ObjectView view = state.View();
  for (Sublattice sublattice : kSublattices) {
    MarkEndPoints(view, sublattice, part.end_points_to_do.Of(sublattice), part.ends);
  }
  for (const MarkedBrick& m : part.ends) {
    BrickBits stubble, stay;
    m.marks.ForEachSetBit([&](int bit) {
      const EndKind kind = Judge(state, m.brick, bit, policy);
      if (kind == EndKind::kStubble) stubble.Set(bit);
      if (kind == EndKind::kStays) stay.Set(bit);
    });
    if (stay != m.marks) dirty[m.brick] |= kEndPointsDirty;
    state.candidates[m.brick] &= ~stay;
    if (stubble.Empty()) continue;
    *part.marks.Room(1) = {stubble, m.brick};
    part.marks.Add(1);
  }
}

void BeginOpening(const Shells& shells, int32_t shell, exec::Share own, SweepWorker& worker) {
  const auto [begin, end] = worker.bricks;
  const size_t first = std::clamp(own.begin, begin, end);
  const size_t last = std::clamp(own.end, first, end);
  worker.opener.Begin(shells, {first, last}, shell);
  worker.ghost_openers[0].Begin(shells, {begin, first}, shell);
  worker.ghost_openers[1].Begin(shells, {last, end}, shell);
}

void TellMarks(std::span<const SweepWorker> workers, SweepPartners& partners) {
  for (const SweepWorker& worker : workers) {
    worker.ForEachPart([&](const SweepPart& part) {
      for (const MarkedBrick& m : part.marks.marked()) partners.Tell(m);
    });
  }
}

}  // namespace bccskel
