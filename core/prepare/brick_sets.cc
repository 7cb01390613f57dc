#include "core/prepare/brick_sets.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <utility>

namespace bccskel {
namespace {

BrickCoordinates Shifted(BrickCoordinates brick, BrickCoordinates by, int32_t times) {
  return {brick.bx + times * by.bx, brick.by + times * by.by, brick.bz + times * by.bz,
          brick.sublattice};
}

// Calls visit(key, a, b) for each brick that is stored in either volume, in order; a brick that is
// not stored is empty.
template <typename Visit>
void ForEachBrickOf(const Volume& a, const Volume& b, Visit visit) {
  const BrickBits none;
  size_t m = 0, n = 0;
  while (m < a.brick_count() || n < b.brick_count()) {
    const bool in_a = m < a.brick_count() && (n == b.brick_count() || a.keys()[m] <= b.keys()[n]);
    const bool in_b = n < b.brick_count() && (m == a.brick_count() || b.keys()[n] <= a.keys()[m]);
    visit(in_a ? a.keys()[m] : b.keys()[n], in_a ? a.bricks()[m] : none,
          in_b ? b.bricks()[n] : none);
    m += in_a ? 1 : 0;
    n += in_b ? 1 : 0;
  }
}

// `join` combines a brick of each into one.
template <typename Join>
Volume Joined(const Volume& a, const Volume& b, Join join) {
  std::vector<BrickKey> keys;
  std::vector<BrickBits> bricks;
  ForEachBrickOf(a, b, [&](BrickKey key, const BrickBits& in_a, const BrickBits& in_b) {
    keys.push_back(key);
    bricks.push_back(join(in_a, in_b));
  });
  return Volume::FromSortedBricks(a.extent(), a.placement(), std::move(keys), std::move(bricks));
}

// Adds to sorted keys those up to `reach` bricks away along one axis. `step` preserves their order,
// so the list is merged with shifted copies of itself, which double its reach.
template <typename Step>
std::vector<BrickKey> Widened(const std::vector<BrickKey>& keys, int32_t reach, Step step) {
  const auto moved = [&](const std::vector<BrickKey>& list, int32_t n) {
    std::vector<BrickKey> there;
    there.reserve(list.size());
    for (BrickKey key : list) there.push_back(BrickKey(step(key.coordinates(), n)));
    return there;
  };
  std::vector<BrickKey> wide = moved(keys, -reach);
  for (int32_t width = 1, last = 2 * reach + 1; width < last;) {
    const int32_t more = std::min(width, last - width);
    std::vector<BrickKey> both;
    std::ranges::set_union(wide, moved(wide, more), std::back_inserter(both));
    wide = std::move(both);
    width += more;
  }
  return wide;
}

}  // namespace

Volume Union(const Volume& a, const Volume& b) {
  return Joined(a, b, [](const BrickBits& x, const BrickBits& y) { return x | y; });
}

Volume Difference(const Volume& a, const Volume& b) {
  return Joined(a, b, [](const BrickBits& x, const BrickBits& y) { return x & ~y; });
}

BrickCoordinates RoomFor(double reach) {
  const auto bricks = [&](int32_t cells) {
    return static_cast<int32_t>(std::ceil((reach + 2) / (2 * cells)));
  };
  return {bricks(kBrickX), bricks(kBrickY), bricks(kBrickZ)};
}

LatticeExtent WithRoom(const LatticeExtent& extent, BrickCoordinates room) {
  const auto cells = [](int32_t inside, int32_t per_brick, int32_t more) {
    return ((inside + per_brick - 1) / per_brick + 2 * more) * per_brick;
  };
  return {cells(extent.nx, kBrickX, room.bx), cells(extent.ny, kBrickY, room.by),
          cells(extent.nz, kBrickZ, room.bz)};
}

Volume ShiftedBy(const Volume& volume, BrickCoordinates by, int32_t times, LatticeExtent extent) {
  std::vector<BrickKey> keys;
  keys.reserve(volume.brick_count());
  for (BrickKey key : volume.keys()) {
    keys.push_back(BrickKey(Shifted(key.coordinates(), by, times)));
  }
  return Volume::FromSortedBricks(extent, volume.placement(), std::move(keys),
                                  {volume.bricks().begin(), volume.bricks().end()});
}

uint64_t MostBricksAround(const Volume& object, BrickCoordinates reach) {
  if (object.empty()) return 0;
  constexpr int32_t kFar = std::numeric_limits<int32_t>::max();
  BrickCoordinates low = {kFar, kFar, kFar}, high = {-1, -1, -1};
  for (BrickKey key : object.keys()) {
    const BrickCoordinates brick = key.coordinates();
    low = {std::min(low.bx, brick.bx), std::min(low.by, brick.by), std::min(low.bz, brick.bz)};
    high = {std::max(high.bx, brick.bx), std::max(high.by, brick.by), std::max(high.bz, brick.bz)};
  }
  const auto places = [&](BrickCoordinates wide) {
    return (wide.bx + 2.0 * reach.bx) * (wide.by + 2.0 * reach.by) * (wide.bz + 2.0 * reach.bz);
  };
  const double each = static_cast<double>(object.brick_count()) * places({1, 1, 1});
  const double box = places({high.bx - low.bx + 1, high.by - low.by + 1, high.bz - low.bz + 1});
  return 2 * static_cast<uint64_t>(std::min(each, box));
}

std::vector<BrickKey> BricksAround(const Volume& object, BrickCoordinates reach) {
  std::vector<BrickKey> keys;
  for (BrickKey key : object.keys()) {
    for (const Sublattice s : {Sublattice::kEven, Sublattice::kOdd}) {
      BrickCoordinates brick = key.coordinates();
      brick.sublattice = s;
      keys.push_back(BrickKey(brick));
    }
  }
  std::ranges::sort(keys);
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
  keys = Widened(keys, reach.bx, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {1, 0, 0}, n);
  });
  keys = Widened(keys, reach.by, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {0, 1, 0}, n);
  });
  return Widened(keys, reach.bz, [](BrickCoordinates brick, int32_t n) {
    return Shifted(brick, {0, 0, 1}, n);
  });
}

}  // namespace bccskel
