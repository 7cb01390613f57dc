#include "core/shells/shells.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <variant>

namespace bccskel {
namespace {

ShellRule RuleFor(const ChamferWeights& weights, double shell_width) {
  return ShellRule(static_cast<uint64_t>(std::llround(weights.half_units * shell_width * 64)));
}

// For objects deeper than 16 bits and for the rare width whose borders single precision misses.
template <typename T>
Shells::Range SliceExactly(const ShellRule& rule, const BrickBits& object, const T* distances,
                           ShellPlanes& planes) {
  Shells::Range range = {INT32_MAX, 0};
  planes = {};
  object.ForEachSetBit([&](int bit) {
    const int32_t shell = rule(distances[bit]);
    range.first = std::min(range.first, shell);
    range.last = std::max(range.last, shell);
    for (int b = 0; b < kShellPlanes; ++b) {
      if ((shell >> b & 1) != 0) planes[static_cast<size_t>(b)].Set(bit);
    }
  });
  return range;
}

// Slices one brick after the other by the fastest exact way.
class Slicer {
 public:
  Slicer(const Volume& object, const ChamferField& distance, const ShellRule& rule)
      : object_(object),
        distance_(distance),
        rule_(rule),
        fast_(MakeFloatRule(rule, distance.largest())) {}

  Shells::Range operator()(size_t brick, ShellPlanes& planes) const {
    return std::visit(
        [&](const auto& values) {
          const auto* distances = values.data() + brick * kBrickPoints;
          if constexpr (std::is_same_v<decltype(distances), const uint16_t*>) {
            if (fast_.exact) {
              const DistanceRange range = SliceBrick(fast_.rule, distances, planes);
              return Shells::Range{rule_(range.smallest), rule_(range.largest)};
            }
          }
          return SliceExactly(rule_, object_.bricks()[brick], distances, planes);
        },
        distance_.values());
  }

 private:
  const Volume& object_;
  const ChamferField& distance_;
  const ShellRule rule_;
  const CheckedFloatRule fast_;
};

}  // namespace

int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width) {
  return RuleFor(weights, shell_width)(distance);
}

Shells BuildShells(const Volume& object, const ChamferField& distance, double shell_width,
                   const exec::Context& context) {
  const Slicer slice(object, distance, RuleFor(distance.weights(), shell_width));
  Shells shells;
  shells.planes_.resize(object.brick_count());
  shells.ranges_.resize(object.brick_count());
  context.Run([&](int worker) {
    const exec::Share share = exec::ShareOf(object.brick_count(), worker, context.threads());
    for (size_t n = share.begin; n < share.end; ++n) {
      shells.ranges_[n] = slice(n, shells.planes_[n]);
    }
  });
  for (const Shells::Range& range : shells.ranges_)
    shells.last_ = std::max(shells.last_, range.last);
  return shells;
}

}  // namespace bccskel
