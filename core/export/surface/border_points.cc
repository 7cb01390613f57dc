#include "core/export/surface/border_points.h"

#include "core/certificate/neighbor_planes.h"

namespace bccskel {
namespace {

NeighborMask BackgroundAt(int bit, const NeighborPlanes& planes) {
  return static_cast<NeighborMask>(kAllNeighbors ^ NeighborsAt(bit, planes));
}

// How many set bits come before `bit`.
size_t RankOf(const BrickBits& bits, int bit) {
  const auto word = static_cast<size_t>(bit >> 6);
  size_t rank = 0;
  for (size_t n = 0; n < word; ++n) rank += static_cast<size_t>(std::popcount(bits.words[n]));
  const uint64_t below = (uint64_t{1} << (bit & 63)) - 1;
  return rank + static_cast<size_t>(std::popcount(bits.words[word] & below));
}

}  // namespace

absl::StatusOr<BorderPoints> BorderPoints::Find(const Volume& object,
                                                const exec::Context& context) {
  BorderPoints border(object);
  for (BrickIndex brick = 0; brick < object.brick_count(); ++brick) {
    if (brick % 1024 == 0 && context.ShouldStop()) return context.StopStatus();
    border.AddBrick(brick);
  }
  return border;
}

void BorderPoints::AddBrick(BrickIndex brick) {
  const BrickCoordinates coordinates = object_->keys()[brick].coordinates();
  const NeighborPlanes planes = NeighborPlanesOf(*object_, brick);
  border_.push_back(BorderOf(object_->bricks()[brick], planes));
  first_of_brick_.push_back(points_.size());
  border_.back().ForEachSetBit([&](int bit) {
    const NeighborMask background = BackgroundAt(bit, planes);
    points_.push_back({PointOf(coordinates, bit), background, vertex_count_});
    vertex_count_ += static_cast<uint64_t>(std::popcount(background));
  });
}

const BorderPoint& BorderPoints::At(LatticePoint p) const {
  const BrickAddress address = AddressOf(p);
  const BrickIndex brick = *object_->Find(BrickKey(address.brick));
  return points_[first_of_brick_[brick] + RankOf(border_[brick], address.bit)];
}

}  // namespace bccskel
