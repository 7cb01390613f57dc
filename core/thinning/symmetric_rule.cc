#include "core/thinning/symmetric_rule.h"

namespace bccskel {
namespace {

// Takes points out of the candidates for good.
void Keep(std::span<const MarkedBrick> points, std::vector<BrickBits>& candidates) {
  for (const MarkedBrick& m : points) {
    for (size_t k = 0; k < m.marks.words.size(); ++k) {
      candidates[m.brick].words[k] &= ~m.marks.words[k];
    }
  }
}

}  // namespace

SymmetricRule::SymmetricRule(const Shells& depth, SkeletonKind kind, ThinningState& state)
    : depth_(depth), kind_(kind), state_(state) {
  for (std::vector<BrickBits>& simple : simple_) simple.resize(state.object.size());
}

void SymmetricRule::Mark(const PassStep& at, BrickLists& bricks, Unsettled* unsettled,
                         MarkBuffer& marks) {
  if (at.step > 0) {
    SendBack(at, bricks, unsettled);
    if (at.step + 1 == steps()) MarkWhatIsLeft(bricks, marks);
    return;
  }
  if (kind_ == SkeletonKind::kSurface || kind_ == SkeletonKind::kIsthmusCurve) {
    KeepIsthmuses(bricks, marks);
  }
  FindSimpleIn(bricks);
}

// Needs: nothing is marked yet, so that the buffer is free.
void SymmetricRule::KeepIsthmuses(const BrickLists& bricks, MarkBuffer& scratch) {
  for (Sublattice sublattice : kSublattices) {
    const std::span<const BrickIndex> list = bricks.Of(sublattice);
    MarkedBrick* found = scratch.Room(list.size());
    const size_t count = MarkIsthmuses(state_.View(), sublattice, kind_, list, found);
    Keep(std::span(found, count), state_.candidates);
  }
}

void SymmetricRule::FindSimpleIn(BrickLists& bricks) {
  std::array<size_t, 2> counts = {};
  for (Sublattice sublattice : kSublattices) {
    counts[static_cast<size_t>(sublattice)] = FindSimple(
        state_.View(), sublattice, EndPointsOf(kind_), bricks.Of(sublattice), simple_[0].data());
  }
  bricks.SetCounts(counts[0], counts[1]);
}

void SymmetricRule::SendBack(const PassStep& at, const BrickLists& bricks, Unsettled* unsettled) {
  const auto from = static_cast<size_t>(at.step + 1) % 2;
  const CliqueView view = {.object = state_.View(),
                           .simple = simple_[from].data(),
                           .depth = depth_.planes().data(),
                           .pass = at.cycle};
  const auto size = static_cast<CliqueSize>(at.step - 1);
  for (Sublattice sublattice : kSublattices) {
    SendBackFromCritical(size, view, sublattice, bricks.Of(sublattice), simple_[1 - from].data(),
                         unsettled);
  }
}

void SymmetricRule::MarkWhatIsLeft(const BrickLists& bricks, MarkBuffer& marks) const {
  const std::vector<BrickBits>& left = simple_[1];
  for (Sublattice sublattice : kSublattices) {
    for (const BrickIndex brick : bricks.Of(sublattice)) {
      *marks.Room(1) = {left[brick], brick};
      marks.Add(left[brick].Empty() ? 0 : 1);
    }
  }
}

void SymmetricRule::Finish(const BrickLists& bricks) {
  for (Sublattice sublattice : kSublattices) {
    for (const BrickIndex brick : bricks.Of(sublattice)) {
      for (std::vector<BrickBits>& simple : simple_) simple[brick] = BrickBits();
    }
  }
}

}  // namespace bccskel
