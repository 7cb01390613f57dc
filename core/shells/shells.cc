#include "core/shells/shells.h"

#include <algorithm>
#include <cmath>

namespace bccskel {
namespace {

// Which shell a distance is in, in integers: the shell grows by one at every multiple of
// `shell_width` minus a half. Counts are scaled by 128 so that half widths are whole.
class ShellRule {
 public:
  ShellRule(const ChamferWeights& weights, double shell_width)
      : width_(static_cast<uint64_t>(std::llround(weights.half_units * shell_width * 64))) {}

  int32_t operator()(uint32_t distance) const {
    const uint64_t shell = (uint64_t{256} * distance + width_) / (2 * width_);
    return std::max(1, static_cast<int32_t>(shell));
  }

 private:
  uint64_t width_;  // of a shell, in 1/128 counts
};

template <typename T>
Shells::Range SliceBrick(const BrickBits& object, const T* distance, const ShellRule& rule,
                         Shells::Planes& planes) {
  Shells::Range range = {INT32_MAX, 0};
  object.ForEachSetBit([&](int bit) {
    const int32_t shell = rule(distance[bit]);
    range.first = std::min(range.first, shell);
    range.last = std::max(range.last, shell);
    for (int b = 0; b < Shells::kPlanes; ++b) {
      if ((shell >> b & 1) != 0) planes[static_cast<size_t>(b)].Set(bit);
    }
  });
  return range;
}

}  // namespace

int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width) {
  return ShellRule(weights, shell_width)(distance);
}

BrickBits Shells::PointsIn(BrickIndex brick, int32_t shell) const {
  const Planes& planes = planes_[brick];
  BrickBits equal;
  for (size_t k = 0; k < equal.words.size(); ++k) {
    uint64_t same = ~uint64_t{0};
    for (int b = 0; b < kPlanes; ++b) {
      const uint64_t wanted = (shell >> b & 1) != 0 ? ~uint64_t{0} : 0;
      same &= ~(planes[static_cast<size_t>(b)].words[k] ^ wanted);
    }
    equal.words[k] = same;
  }
  return equal;
}

Shells BuildShells(const Volume& object, const ChamferField& distance, double shell_width,
                   const exec::Context& context) {
  const ShellRule rule(distance.weights(), shell_width);
  Shells shells;
  shells.planes_.resize(object.brick_count());
  shells.ranges_.resize(object.brick_count());
  std::visit(
      [&](const auto& values) {
        context.Run([&](int worker) {
          const exec::Share share = exec::ShareOf(object.brick_count(), worker, context.threads());
          for (size_t n = share.begin; n < share.end; ++n) {
            shells.ranges_[n] = SliceBrick(object.bricks()[n], values.data() + n * kBrickPoints,
                                           rule, shells.planes_[n]);
          }
        });
      },
      distance.values());
  for (const Shells::Range& range : shells.ranges_)
    shells.last_ = std::max(shells.last_, range.last);
  return shells;
}

}  // namespace bccskel
