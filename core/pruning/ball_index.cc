#include "core/pruning/ball_index.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace bccskel {
namespace {

constexpr double kInside = 0.9;  // in radii

// A radius of a level is less than two to the power of the level.
size_t LevelOf(float radius) {
  return static_cast<size_t>(std::bit_width(static_cast<uint32_t>(radius)));
}

}  // namespace

BallIndex::BallIndex(const ThinSet& set, const AxisScale& scale) : scale_(scale) {
  set.ForEachPoint([&](LatticePoint p) {
    const float radius = set.RadiusOf(p);
    const size_t level = std::min(LevelOf(radius), kLevels - 1);
    levels_[level][CubeOf(p, level)].push_back({p, radius});
  });
}

bool BallIndex::IsCovered(LatticePoint p, double way, const ThinSet& set,
                          const PointSet& own) const {
  const Coordinates place = PlaceOf(p, scale_);
  const auto covers = [&](const Ball& ball) {
    const Coordinates between = Sum(PlaceOf(ball.center, scale_), -1, place);
    const double reach = kInside * ball.radius;
    return Dot(between, between) < reach * reach && 2 * ball.radius < way &&
           !own.contains(ball.center) && set.Contains(ball.center);
  };
  // Balls of a level have at least half the radius of its cubes' width.
  for (size_t level = 0; level < kLevels && std::ldexp(1.0, static_cast<int>(level)) <= way;
       ++level) {
    if (levels_[level].empty()) continue;
    const LatticePoint cube = CubeOf(p, level);
    for (int32_t n = 0; n < 27; ++n) {
      const LatticePoint offset{n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1};
      const auto found = levels_[level].find(cube + offset);
      if (found != levels_[level].end() && std::ranges::any_of(found->second, covers)) return true;
    }
  }
  return false;
}

LatticePoint BallIndex::CubeOf(LatticePoint p, size_t level) const {
  const auto at = [&](size_t axis, int32_t v) {
    return static_cast<int32_t>(std::floor(std::ldexp(scale_[axis] * v, -static_cast<int>(level))));
  };
  return {at(0, p.x), at(1, p.y), at(2, p.z)};
}

}  // namespace bccskel
