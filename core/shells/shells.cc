#include "core/shells/shells.h"

#include <algorithm>
#include <cmath>
#include <variant>

namespace bccskel {
namespace {

ShellRule RuleFor(const ChamferWeights& weights, double shell_width) {
  return ShellRule(
      static_cast<uint64_t>(std::llround(weights.counts_per_unit * shell_width * 128)));
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
  Slicer(const Volume& object, const DistanceField& distance, double width)
      : object_(object),
        distance_(distance),
        euclidean_(width),
        chamfer_(RuleFor(distance.weights(), width)) {
    if (distance.kind() != DistanceKind::kEuclidean) {
      fast_ = MakeFloatRule(chamfer_, distance.largest());
    }
  }

  Shells::Range operator()(size_t brick, ShellPlanes& planes) const {
    return std::visit(
        [&](const auto& values) {
          return Slice(brick, values.data() + brick * kBrickPoints, planes);
        },
        distance_.values());
  }

 private:
  template <typename T>
  Shells::Range SliceSquares(const T* squares, ShellPlanes& planes) const {
    const SquaredRange range = SliceBrick(euclidean_, squares, planes);
    return {euclidean_(range.smallest), euclidean_(range.largest)};
  }
  Shells::Range Slice(size_t, const float* squares, ShellPlanes& planes) const {
    return SliceSquares(squares, planes);
  }
  Shells::Range Slice(size_t brick, const uint16_t* distances, ShellPlanes& planes) const {
    if (distance_.kind() == DistanceKind::kEuclidean) return SliceSquares(distances, planes);
    if (!fast_.exact) return SliceExactly(chamfer_, object_.bricks()[brick], distances, planes);
    const DistanceRange range = SliceBrick(fast_.rule, distances, planes);
    return {chamfer_(range.smallest), chamfer_(range.largest)};
  }
  Shells::Range Slice(size_t brick, const uint32_t* distances, ShellPlanes& planes) const {
    return SliceExactly(chamfer_, object_.bricks()[brick], distances, planes);
  }

  const Volume& object_;
  const DistanceField& distance_;
  const EuclideanShellRule euclidean_;
  const ShellRule chamfer_;
  CheckedFloatRule fast_ = {};
};

}  // namespace

Shells SliceAll(const Volume& object, const DistanceField& distance, double width,
                const exec::Context& context) {
  const Slicer slice(object, distance, width);
  Shells shells;
  shells.planes_.resize(object.brick_count() + 1);
  shells.planes_.back() = {};
  shells.ranges_.resize(object.brick_count());
  context.Run([&](int worker) {
    const exec::Share share = exec::ShareOf(object.brick_count(), worker, context.threads());
    for (size_t n = share.begin; n < share.end; ++n) {
      shells.ranges_[n] = slice(n, shells.planes_[n]);
    }
  });
  for (const Shells::Range& range : shells.ranges_) {
    shells.last_ = std::max(shells.last_, range.last);
  }
  return shells;
}

int32_t ShellOf(uint32_t distance, const ChamferWeights& weights, double shell_width) {
  return RuleFor(weights, shell_width)(distance);
}

// Distances of two points of a brick differ by no more than the distance between them, which for
// chamfer distances is a bit longer than the straight one.
double EffectiveShellWidth(double wanted, const AxisScale& scale) {
  const double x = 2 * (kBrickX - 1) * scale[0], y = 2 * (kBrickY - 1) * scale[1],
               z = 2 * (kBrickZ - 1) * scale[2];
  const double across = LargestOverestimate(scale) * std::sqrt(x * x + y * y + z * z);
  return std::max(wanted, across / 62);
}

double DepthWidth(const AxisScale& scale) {
  const double longest_step = 2 * std::max({scale[0], scale[1], scale[2]});
  return std::max(0.25, LargestOverestimate(scale) * longest_step / 14);
}

Shells BuildShells(const Volume& object, const DistanceField& distance, double shell_width,
                   const exec::Context& context) {
  const double width = EffectiveShellWidth(shell_width, AxisScaleOf(object.placement()));
  return SliceAll(object, distance, width, context);
}

Shells BuildDepths(const Volume& object, const DistanceField& distance,
                   const exec::Context& context) {
  return SliceAll(object, distance, DepthWidth(AxisScaleOf(object.placement())), context);
}

}  // namespace bccskel
