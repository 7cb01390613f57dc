#include "core/certificate/phase_components.h"

#include "core/certificate/brick_sum.h"

namespace bccskel {

PhaseComponents::PhaseComponents(const Volume& object, Phase phase, const exec::Context& context)
    : object_(object),
      flip_(phase == Phase::kObject ? 0 : ~uint64_t{0}),
      first_(object.brick_count() + 2, 0),
      fragments_(object.brick_count() + 1, nullptr),
      store_(static_cast<size_t>(context.threads())) {
  SumOverBricks(context, object.brick_count(), [this](int worker, size_t n) {
    return SplitIntoComponents(worker, static_cast<BrickIndex>(n));
  });
  // The counts stand one place later than the first numbers that they lead to.
  for (size_t n = 1; n < first_.size(); ++n) first_[n] += first_[n - 1];
}

int64_t PhaseComponents::SplitIntoComponents(int worker, BrickIndex n) {
  const BrickBits points = PointsOf(n);
  if (points.Empty()) return 0;
  first_[n + 1] = 1;
  if (IsPlainlyConnected(points)) return 1;
  BrickFragments split = SplitBrick(points);
  const int components = split.components;
  if (components == 1) return 1;
  first_[n + 1] = static_cast<size_t>(components);
  fragments_[n] = &store_[static_cast<size_t>(worker)].emplace_back(split);
  return components;
}

BrickBits PhaseComponents::PointsOf(BrickIndex n) const {
  BrickBits points = object_.padded_bricks()[n];
  if (n == object_.brick_count()) return points;
  for (uint64_t& word : points.words) word ^= flip_;
  return points;
}

BrickBits PhaseComponents::MainPointsOf(BrickIndex n) const {
  BrickBits points = PointsOf(n);
  if (fragments_[n] == nullptr) return points;
  for (size_t k = 0; k < 8; ++k) points.words[k] &= ~fragments_[n]->fragments.words[k];
  return points;
}

BrickBits PhaseComponents::FragmentPointsOf(BrickIndex n) const {
  return fragments_[n] == nullptr ? BrickBits{} : fragments_[n]->fragments;
}

}  // namespace bccskel
