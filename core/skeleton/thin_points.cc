#include "core/skeleton/thin_points.h"

#include <algorithm>
#include <optional>

namespace bccskel {

ThinPoints::ThinPoints(const Volume& thin, const Volume& object, const ChamferField& distance,
                       StopPoll& poll) {
  Gather(thin, object, distance, poll);
  FindNeighbors(poll);
}

PointIndex ThinPoints::DeepestOf(std::span<const PointIndex> some) const {
  return *std::ranges::min_element(some, [this](PointIndex p, PointIndex q) {
    const uint32_t a = points_[p].distance, b = points_[q].distance;
    return a != b ? a > b : p < q;
  });
}

// Bricks come in order of bz, and bricks of different bz hold different z: sorting each layer of
// bricks sorts all points.
void ThinPoints::Gather(const Volume& thin, const Volume& object, const ChamferField& distance,
                        StopPoll& poll) {
  size_t layer_begin = 0;
  int32_t layer = 0;
  const auto sort_layer = [&] {
    std::sort(points_.begin() + static_cast<ptrdiff_t>(layer_begin), points_.end());
    layer_begin = points_.size();
  };
  for (size_t n = 0; n < thin.brick_count() && !poll.Stopped(); ++n) {
    const BrickCoordinates brick = thin.keys()[n].coordinates();
    if (brick.bz != layer) sort_layer();
    layer = brick.bz;
    const std::optional<BrickIndex> deep = object.Find(thin.keys()[n]);
    thin.bricks()[n].ForEachSetBit([&](int bit) {
      points_.push_back({PointOf(brick, bit), deep ? distance.At(*deep, bit) : 0});
    });
  }
  sort_layer();
}

// For each direction the wanted neighbors come in the order of the points, so one walk through the
// list finds them all.
void ThinPoints::FindNeighbors(StopPoll& poll) {
  masks_.assign(size(), 0);
  first_.assign(size() + 1, 0);
  std::vector<std::array<PointIndex, kNeighborCount>> found(size());
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    PointIndex at = 0;
    for (PointIndex p = 0; p < size() && !poll.Stopped(); ++p) {
      const LatticePoint wanted = points_[p].point + d.offset();
      while (at < size() && points_[at].point < wanted) ++at;
      if (at == size()) break;
      if (points_[at].point != wanted) continue;
      masks_[p] = static_cast<NeighborMask>(masks_[p] | d.mask());
      found[p][static_cast<size_t>(bit)] = at;
    }
  }
  for (PointIndex p = 0; p < size(); ++p) {
    ForEachDirection(masks_[p], [&](Direction d) {
      neighbors_.push_back(found[p][static_cast<size_t>(d.bit())]);
    });
    first_[p + 1] = neighbors_.size();
  }
}

}  // namespace bccskel
