#include "core/pruning/ball_index.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <utility>

#include "core/exec/stop_poll.h"

namespace bccskel {
namespace {

constexpr double kInside = 0.9;    // in radii
constexpr double kRounding = 0.1;  // lattice units, more than that of radii
constexpr Coordinates kAlongAll = {1, 1, 1};

// Radii of a level are less than 2^level.
size_t LevelOf(float radius) {
  return static_cast<size_t>(std::bit_width(static_cast<uint32_t>(radius)));
}

}  // namespace

BallIndex::BallIndex(const ThinSet& set, const exec::Context& context) : scale_(set.scale()) {
  StopPoll poll(context);
  auto shared = std::make_shared<Cubes>();
  std::vector<Ball>& balls = shared->balls;
  std::vector<Cube>& cubes = shared->cubes;
  auto& levels = shared->levels;
  std::vector<uint32_t> cube_of;  // of each point, in the order of the set
  cube_of.reserve(set.size());
  set.ForEachBall([&](LatticePoint p, float radius) {
    if (poll.Stopped()) return;
    const size_t level = std::min(LevelOf(radius), kLevels - 1);
    const LatticePoint at = CubeOf(PlaceOf(p, scale_), level);
    const uint32_t* known = levels[level].Find(at);
    const auto cube = known != nullptr ? *known : static_cast<uint32_t>(cubes.size());
    if (known == nullptr) {
      levels[level].Set(at, cube);
      cubes.emplace_back();
    }
    ++cubes[cube].end;  // how many there are, for now
    cube_of.push_back(cube);
  });
  uint32_t first = 0;
  for (Cube& cube : cubes) {
    const uint32_t count = cube.end;
    cube = {first, first};
    first += count;
  }
  balls.resize(cube_of.size());
  size_t n = 0;
  set.ForEachBall([&](LatticePoint p, float radius) {
    if (n < cube_of.size()) balls[cubes[cube_of[n++]].end++] = {p, radius};
  });
  shared_ = std::move(shared);
}

void BallIndex::SetOwn(std::span<const LatticePoint> own) {
  own_ = {};
  own_.Reserve(own.size());
  for (LatticePoint p : own) own_.Set(p, 0);
}

// Where a ball covers p, at least a tenth of its radius remains to the background.
bool BallIndex::IsCovered(LatticePoint p, double radius, double distance_to_junction,
                          const ThinSet& set) const {
  const double largest = std::min(distance_to_junction / 2, radius / (1 - kInside) + kRounding);
  const Coordinates place = PlaceOf(p, scale_);
  const auto covers = [&](const Ball& ball) {
    const Coordinates between = Sum(PlaceOf(ball.center, scale_), -1, place);
    const double reach = kInside * ball.radius;
    return Dot(between, between) < reach * reach && 2 * ball.radius < distance_to_junction &&
           own_.Find(ball.center) == nullptr && set.Contains(ball.center);
  };
  double width = 1;  // radii of a level are at least half of this, or 0
  for (size_t level = 0; level < kLevels && width / 2 <= largest; ++level, width *= 2) {
    const PointTable<uint32_t>& cubes = shared_->levels[level];
    if (cubes.empty()) continue;
    const double reach = kInside * width;
    const LatticePoint low = CubeOf(Sum(place, -reach, kAlongAll), level);
    const LatticePoint high = CubeOf(Sum(place, reach, kAlongAll), level);
    for (int32_t z = low.z; z <= high.z; ++z) {
      for (int32_t y = low.y; y <= high.y; ++y) {
        for (int32_t x = low.x; x <= high.x; ++x) {
          const uint32_t* number = cubes.Find({x, y, z});
          const Cube cube = number != nullptr ? shared_->cubes[*number] : Cube();
          for (uint32_t n = cube.first; n < cube.end; ++n) {
            if (covers(shared_->balls[n])) return true;
          }
        }
      }
    }
  }
  return false;
}

// Rounding is monotonic, so the cube of a place between two others lies between their cubes. Avoids
// a library call.
LatticePoint BallIndex::CubeOf(const Coordinates& place, size_t level) {
  constexpr int32_t kMost = 1 << 20;
  const double cubes_per_unit = 1 / static_cast<double>(uint64_t{2} << level);
  const auto at = [&](size_t axis) {
    return static_cast<int32_t>(place[axis] * cubes_per_unit + kMost) - kMost;
  };
  return {at(0), at(1), at(2)};
}

}  // namespace bccskel
