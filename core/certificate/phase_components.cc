#include "core/certificate/phase_components.h"

#include "core/certificate/brick_sum.h"

namespace bccskel {

PhaseComponents::PhaseComponents(const Volume& object, Phase phase, const exec::Context& context)
    : connectivity_(object.brick_count()),
      mains_(object.brick_count() + 1),
      fragments_(object.brick_count() + 1, nullptr),
      store_(static_cast<size_t>(context.threads())) {
  if (phase == Phase::kBackground) mains_.back() = ~BrickBits();
  count_ = SumOverBricks(context, object.brick_count(), [&](int worker, exec::Share batch) {
    const size_t size = batch.end - batch.begin;
    TestConnectivity(object.bricks().subspan(batch.begin, size), phase,
                     std::span(mains_).subspan(batch.begin, size),
                     std::span(connectivity_).subspan(batch.begin, size));
    int64_t count = 0;
    for (size_t n = batch.begin; n < batch.end; ++n) {
      count += CountComponents(worker, static_cast<BrickIndex>(n));
    }
    return count;
  });
  NumberFragments();
}

int64_t PhaseComponents::CountComponents(int worker, BrickIndex n) {
  if (connectivity_[n] == Connectivity::kEmpty) return 0;
  if (connectivity_[n] == Connectivity::kConnected || IsConnected(mains_[n])) return 1;
  const BrickFragments& split =
      store_[static_cast<size_t>(worker)].emplace_back(SplitBrick(mains_[n]));
  fragments_[n] = &split;
  mains_[n] &= ~split.fragments;
  return split.components;
}

void PhaseComponents::NumberFragments() {
  number_limit_ = mains_.size();
  for (std::deque<BrickFragments>& some : store_) {
    for (BrickFragments& split : some) {
      split.first_number = number_limit_;
      number_limit_ += static_cast<size_t>(split.components) - 1;
    }
  }
}

}  // namespace bccskel
