#include "core/skeleton/thin_points.h"

#include <algorithm>
#include <limits>

#include "absl/numeric/int128.h"

namespace bccskel {
namespace {

// Fields have room for a step beyond either end, so that adding a step never carries from one into
// the next.
constexpr int32_t kRoom = 2;

// Sorts like the point.
template <typename Key>
Key KeyOf(LatticePoint p) {
  constexpr int kBits = sizeof(Key) * 8 / 3;
  const auto field = [](int32_t v) { return Key{static_cast<uint32_t>(v + kRoom)}; };
  return field(p.z) << (2 * kBits) | field(p.y) << kBits | field(p.x);
}

bool FitsShortKeys(const LatticeExtent& extent) {
  return 2 * std::max({extent.nx, extent.ny, extent.nz}) + 2 * kRoom < 1 << 21;
}

// One of each pair of opposite directions: the one to larger points.
bool IsForward(Direction d) { return LatticePoint{} < d.offset(); }

}  // namespace

ThinPoints::ThinPoints(const ThinSkeleton& skeleton, StopPoll& poll) {
  Gather(skeleton, poll);
  if (FitsShortKeys(skeleton.points.extent())) {
    FindNeighbors<uint64_t>(poll);
  } else {
    FindNeighbors<absl::uint128>(poll);
  }
}

ThinPoints::ThinPoints(const ThinPoints& all, std::span<const PointIndex> some, StopPoll& poll)
    : masks_(some.size(), 0), neighbors_(some.size()) {
  std::vector<PointIndex> place(all.size(), 0);  // from 1; 0 for the others
  points_.reserve(some.size());
  for (const PointIndex p : some) {
    points_.push_back(all.points_[p]);
    place[p] = static_cast<PointIndex>(points_.size());
  }
  for (PointIndex n = 0; n < size() && !poll.Stopped(); ++n) {
    ForEachDirection(all.masks_[some[n]], [&](Direction d) {
      const PointIndex neighbor = place[all.Neighbor(some[n], d)];
      if (neighbor == 0) return;
      masks_[n] = With(masks_[n], d);
      neighbors_[n][static_cast<size_t>(d.bit())] = neighbor - 1;
    });
  }
}

PointIndex ThinPoints::DeepestOf(std::span<const PointIndex> some) const {
  return *std::ranges::min_element(some, [this](PointIndex p, PointIndex q) {
    const float a = points_[p].at.radius, b = points_[q].at.radius;
    return a != b ? a > b : p < q;
  });
}

// Bricks come in order of bz, and bricks of different bz hold different z: sorting each layer of
// bricks sorts all points.
void ThinPoints::Gather(const ThinSkeleton& skeleton, StopPoll& poll) {
  const Volume& thin = skeleton.points;
  size_t layer_begin = 0;
  int32_t layer = 0;
  const auto sort_layer = [&] {
    const auto begin = points_.begin() + static_cast<ptrdiff_t>(layer_begin);
    std::ranges::sort(begin, points_.end(), {}, [](const Point& p) { return p.at.point; });
    layer_begin = points_.size();
  };
  for (size_t n = 0; n < thin.brick_count() && !poll.Stopped(); ++n) {
    const BrickCoordinates brick = thin.keys()[n].coordinates();
    if (brick.bz != layer) {
      if (poll.StoppedNow()) return;
      sort_layer();
    }
    layer = brick.bz;
    thin.bricks()[n].ForEachSetBit([&](int bit) {
      const size_t at = points_.size();
      const int32_t birth = skeleton.births.empty() ? 0 : skeleton.births[at];
      const double level = skeleton.levels.empty() ? kNoLevel : skeleton.levels[at];
      points_.push_back({{PointOf(brick, bit), skeleton.radii[at], birth}, level});
    });
  }
  sort_layer();
}

template <typename Key>
void ThinPoints::FindNeighbors(StopPoll& poll) {
  masks_.assign(size(), 0);
  neighbors_.resize(size());
  std::vector<Key> keys;
  keys.reserve(size() + 1);
  for (const Point& p : points_) keys.push_back(KeyOf<Key>(p.at.point));
  keys.push_back(std::numeric_limits<Key>::max());
  if (poll.StoppedNow()) return;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if (IsForward(Direction(bit))) LinkAlong<Key>(Direction(bit), keys, poll);
  }
}

// The wanted neighbors come in the order of the points, so one walk through the list finds them
// all, and with them the neighbors the other way.
template <typename Key>
void ThinPoints::LinkAlong(Direction d, std::span<const Key> keys, StopPoll& poll) {
  const Key step = KeyOf<Key>(d.offset()) - KeyOf<Key>({});
  PointIndex at = 0;
  for (PointIndex p = 0; p < size() && !poll.Stopped(); ++p) {
    const Key wanted = keys[p] + step;
    while (keys[at] < wanted) ++at;
    if (keys[at] != wanted) continue;
    masks_[p] = With(masks_[p], d);
    masks_[at] = With(masks_[at], d.Opposite());
    neighbors_[p][static_cast<size_t>(d.bit())] = at;
    neighbors_[at][static_cast<size_t>(d.Opposite().bit())] = p;
  }
}

}  // namespace bccskel
