#include "core/thinning/sweep_worker.h"

#include <algorithm>

#include "core/thinning/stubble.h"

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

void Take(const BrickBits& points, BrickBits& from) {
  for (size_t k = 0; k < from.words.size(); ++k) from.words[k] &= ~points.words[k];
}

void Reserve(size_t bricks, SweepPart& part) {
  part.to_do.Reserve(bricks);
  part.end_points_to_do.Reserve(bricks);
}

}  // namespace

void SplitParts(const ThinningState& state, SweepWorker& worker) {
  const auto [begin, end] = worker.bricks;
  size_t low = begin, high = end;
  if (begin > 0 && begin < end) low = FirstFromLayer(state, LayerOf(state, begin - 1) + 2);
  if (begin < end && end < state.brick_count()) {
    high = FirstFromLayer(state, LayerOf(state, end) - 1);
  }
  low = std::clamp(RoundUp(low), begin, end);
  high = std::clamp(high / kDirtyGroup * kDirtyGroup, low, end);
  worker.parts[0].bricks = {begin, low};
  worker.parts[1].bricks = {high, end};
  worker.parts[2].bricks = {low, high};
  for (SweepPart& part : worker.parts) Reserve(part.bricks.end - part.bricks.begin, part);
}

void SplitSlabs(const ThinningState& state, int steps, SweepWorker& worker) {
  const size_t end = state.brick_count();
  size_t most = 0;
  worker.slabs.clear();
  for (size_t begin = 0; begin < end;) {
    // Below may be layers without bricks.
    const int32_t below = LayerOf(state, begin) - 1;
    const int32_t touched = begin == 0 ? below : std::max(below, LayerOf(state, begin - 1));
    const size_t next = std::min(RoundUp(FirstFromLayer(state, touched + 2)), end);
    worker.slabs.push_back({begin, next});
    most = std::max(most, next - begin);
    begin = next;
  }
  worker.slab_parts.resize(static_cast<size_t>(steps) + 1);
  for (SweepPart& part : worker.slab_parts) Reserve(most, part);
}

void MarkBorder(const ThinningState& state, const SweepWorker& worker, std::span<DirtyMask> dirty) {
  const exec::Share own = worker.bricks;
  for (size_t n = own.begin; n < own.end; ++n) {
    const bool border = std::ranges::any_of(state.neighbors[n], [&](BrickIndex other) {
      return other < state.brick_count() && (other < own.begin || other >= own.end);
    });
    if (border) dirty[n] |= kBorderBrick;
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
    const JudgedEnds judged = JudgeEnds(state, m, policy);
    if (judged.stay != m.marks) dirty[m.brick] |= kEndPointsDirty;
    Take(judged.stay, state.candidates[m.brick]);
    if (judged.stubble.Empty()) continue;
    *part.marks.Room(1) = {judged.stubble, m.brick};
    part.marks.Add(1);
  }
}

void BeginOpening(const Shells& shells, exec::Share own, SweepWorker& worker) {
  const auto [begin, end] = worker.bricks;
  const size_t first = std::clamp(own.begin, begin, end);
  const size_t last = std::clamp(own.end, first, end);
  worker.opener.Begin(shells, {first, last});
  worker.ghost_openers[0].Begin(shells, {begin, first});
  worker.ghost_openers[1].Begin(shells, {last, end});
}

void TellMarks(std::span<const SweepWorker> workers, SweepPartners& partners) {
  for (const SweepWorker& worker : workers) {
    for (const SweepPart& part : worker.parts) {
      for (const MarkedBrick& m : part.marks.marked()) partners.Tell(m);
    }
  }
}

}  // namespace bccskel
