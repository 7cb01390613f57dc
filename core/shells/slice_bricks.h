#ifndef BCCSKEL_CORE_SHELLS_SLICE_BRICKS_H_
#define BCCSKEL_CORE_SHELLS_SLICE_BRICKS_H_

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/volume/brick.h"

namespace bccskel {

inline constexpr int kShellPlanes = 6;
using ShellPlanes = std::array<BrickBits, kShellPlanes>;
// The planes of depths: see BrickDepths.
inline constexpr int kDepthPlanes = 5;
using DepthPlanes = std::array<BrickBits, kDepthPlanes>;

// The exact rule from distances to shells: the shell grows by one at every multiple of the width
// minus half of it. Lengths are scaled by 128 so that half widths are integers.
class ShellRule {
 public:
  explicit ShellRule(uint64_t scaled_width) : width_(scaled_width) {}

  int32_t operator()(uint32_t distance) const {
    const uint64_t shell = (uint64_t{256} * distance + width_) / (2 * width_);
    return shell < 1 ? 1 : static_cast<int32_t>(shell);
  }
  uint64_t width() const { return width_; }

 private:
  uint64_t width_;  // of a shell, in 1/128 counts
};

// The same in single precision: shell = max(1, trunc(distance * scale + offset)).
struct FloatShellRule {
  float scale;
  float offset;
};

// Finds factors that give ShellRule's result for every distance up to `largest`. Rounding is
// monotonic, so it checks only both sides of each shell's border. Returns the factors and whether
// they are exact.
struct CheckedFloatRule {
  FloatShellRule rule;
  bool exact;
};
CheckedFloatRule MakeFloatRule(const ShellRule& exact, uint32_t largest);

// The smallest and the largest nonzero distance of a brick; {0xffff, 0} if all are zero.
struct DistanceRange {
  uint16_t smallest;
  uint16_t largest;
};

// Slices shell modulo 64 of every point of a brick into planes.
// Shapes: `distances` holds kBrickPoints values in bit order.
DistanceRange SliceBrick(const FloatShellRule& rule, const uint16_t* distances,
                         ShellPlanes& planes);

// The shell of a squared Euclidean distance in lattice units, in single precision, which every
// machine rounds alike; exact for integer squares, distances up to 500 and widths in quarters.
class EuclideanShellRule {
 public:
  explicit EuclideanShellRule(double width) : width_(static_cast<float>(width)) {}

  int32_t operator()(float squared) const {
    const auto shell = static_cast<int32_t>(std::sqrt(squared) / width_ + 0.5f);
    return shell < 1 ? 1 : shell;
  }
  float width() const { return width_; }

 private:
  float width_;
};

// The smallest and the largest nonzero value of a brick; the largest is 0 if all are zero.
struct SquaredRange {
  float smallest;
  float largest;
};
struct SquareRules {
  SquareRules(double shell_width, double depth_width) : shell(shell_width), depth(depth_width) {}

  EuclideanShellRule shell;
  EuclideanShellRule depth;
};
// Slices shells and, unless `depths` is null, depths modulo 32.
SquaredRange SliceBrick(const SquareRules& rules, const float* squared, ShellPlanes& planes,
                        DepthPlanes* depths);
SquaredRange SliceBrick(const SquareRules& rules, const uint16_t* squared, ShellPlanes& planes,
                        DepthPlanes* depths);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SHELLS_SLICE_BRICKS_H_
