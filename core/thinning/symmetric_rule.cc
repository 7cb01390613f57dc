#include "core/thinning/symmetric_rule.h"

#include <algorithm>

namespace bccskel {
SymmetricRule::SymmetricRule(const BrickDepths& depth, SkeletonKind kind, ThinningState& state)
    : depth_(depth), kind_(kind), state_(state), larger_cliques_(state.object.size()) {
  for (std::vector<BrickBits>& simple : simple_) simple.resize(state.object.size());
}

void SymmetricRule::Mark(const PassStep& at, BrickLists& bricks, DirtyMask* dirty,
                         MarkBuffer& marks, std::vector<MarkedBrick>& ends) {
  if (at.step == 0) {
    if (kind_ == SkeletonKind::kSurface || kind_ == SkeletonKind::kIsthmusCurve) {
      KeepIsthmuses(at.cycle + 1, bricks, marks);
    }
    return FindSimpleIn(bricks, ends);
  }
  const RuleBView view = ViewOf(at, dirty);
  for (Sublattice sublattice : kSublattices) {
    const std::span<const BrickIndex> list = bricks.Of(sublattice);
    if (at.step == 2) {
      SendBackFromTriples(view, sublattice, list);
      continue;
    }
    MarkedBrick* room = marks.Room(list.size());
    marks.Add(at.step == 1 ? SendBackFromPairs(view, sublattice, list, room)
                           : SendBackFromQuadruples(view, sublattice, list, room));
  }
}

RuleBView SymmetricRule::ViewOf(const PassStep& at, DirtyMask* dirty) {
  return {.object = state_.View(),
          .simple = simple_[0].data(),
          .after_pairs = simple_[1].data(),
          .after_triples = simple_[2].data(),
          .depth = depth_.data(),
          .larger_cliques = larger_cliques_.data(),
          .dirty = dirty,
          .pass = at.cycle};
}

// Needs: nothing is marked yet, so that the buffer is free.
void SymmetricRule::KeepIsthmuses(int32_t pass, const BrickLists& bricks, MarkBuffer& scratch) {
  for (Sublattice sublattice : kSublattices) {
    const std::span<const BrickIndex> list = bricks.Of(sublattice);
    MarkedBrick* found = scratch.Room(list.size());
    const size_t count = MarkIsthmuses(state_.View(), sublattice, kind_, list, found);
    Keep(pass, std::span(found, count));
  }
}

// Removes points from the candidates for good.
void SymmetricRule::Keep(int32_t pass, std::span<const MarkedBrick> points) {
  for (const MarkedBrick& m : points) state_.candidates[m.brick] &= ~m.marks;
  const std::lock_guard lock(births_mutex_);
  for (const MarkedBrick& m : points) births_.push_back({m, pass});
}

std::vector<IsthmusBirth> SymmetricRule::Isthmuses() const {
  std::vector<IsthmusBirth> isthmuses;
  for (const Births& births : births_) {
    const BrickCoordinates brick = state_.keys[births.points.brick].coordinates();
    births.points.marks.ForEachSetBit([&](int bit) {
      isthmuses.push_back({PointOf(brick, bit), births.pass});
    });
  }
  std::ranges::sort(isthmuses, {}, &IsthmusBirth::point);
  return isthmuses;
}

void SymmetricRule::FindSimpleIn(BrickLists& bricks, std::vector<MarkedBrick>& ends) {
  std::array<size_t, 2> counts = {};
  for (Sublattice sublattice : kSublattices) {
    counts[static_cast<size_t>(sublattice)] =
        FindSimple(state_.View(), sublattice, EndPointsOf(kind_), bricks.Of(sublattice),
                   simple_[0].data(), ends);
  }
  bricks.SetCounts(counts[0], counts[1]);
}

void SymmetricRule::Finish(const BrickLists& bricks) {
  for (Sublattice sublattice : kSublattices) {
    for (const BrickIndex brick : bricks.Of(sublattice)) {
      for (std::vector<BrickBits>& simple : simple_) simple[brick] = BrickBits();
    }
  }
}

}  // namespace bccskel
