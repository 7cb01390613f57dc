#include "core/pruning/ball_index.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

namespace bccskel {
namespace {

constexpr double kInside = 0.9;  // in radii
constexpr Coordinates kAlongAll = {1, 1, 1};

// A radius of a level is less than two to the power of the level.
size_t LevelOf(float radius) {
  return static_cast<size_t>(std::bit_width(static_cast<uint32_t>(radius)));
}

}  // namespace

BallIndex::BallIndex(const ThinSet& set, const AxisScale& scale) : scale_(scale) {
  set.ForEachPoint([&](LatticePoint p) {
    const float radius = set.RadiusOf(p);
    const size_t level = std::min(LevelOf(radius), kLevels - 1);
    const LatticePoint cube = CubeOf(PlaceOf(p, scale_), level);
    uint32_t* first = levels_[level].Find(cube);
    const auto here = static_cast<uint32_t>(balls_.size());
    balls_.push_back({p, radius, first != nullptr ? *first : kLast});
    if (first != nullptr) {
      *first = here;
    } else {
      levels_[level].Set(cube, here);
    }
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
    const Cubes& cubes = levels_[level];
    if (cubes.empty()) continue;
    const double reach = kInside * std::ldexp(1.0, static_cast<int>(level));
    const LatticePoint low = CubeOf(Sum(place, -reach, kAlongAll), level);
    const LatticePoint high = CubeOf(Sum(place, reach, kAlongAll), level);
    for (int32_t z = low.z; z <= high.z; ++z) {
      for (int32_t y = low.y; y <= high.y; ++y) {
        for (int32_t x = low.x; x <= high.x; ++x) {
          const uint32_t* first = cubes.Find({x, y, z});
          for (uint32_t n = first != nullptr ? *first : kLast; n != kLast; n = balls_[n].next) {
            if (covers(balls_[n])) return true;
          }
        }
      }
    }
  }
  return false;
}

LatticePoint BallIndex::CubeOf(const Coordinates& place, size_t level) {
  const double cubes_per_unit = std::ldexp(1.0, -static_cast<int>(level) - 1);
  const auto at = [&](size_t axis) {
    return static_cast<int32_t>(std::floor(place[axis] * cubes_per_unit));
  };
  return {at(0), at(1), at(2)};
}

}  // namespace bccskel
