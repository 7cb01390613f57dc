#include "tests/support/reference_point_set.h"

#include <algorithm>

namespace bccskel::test {

ReferencePointSet::ReferencePointSet(std::span<const LatticePoint> points) {
  if (!points.empty()) low_ = high_ = points.front();
  for (LatticePoint p : points) {
    low_ = {std::min(low_.x, p.x), std::min(low_.y, p.y), std::min(low_.z, p.z)};
    high_ = {std::max(high_.x, p.x), std::max(high_.y, p.y), std::max(high_.z, p.z)};
  }
  low_ = low_ - LatticePoint{kMargin, kMargin, kMargin};
  high_ = high_ + LatticePoint{kMargin, kMargin, kMargin};
  inside_.resize(Index(high_) + 1);
  for (LatticePoint p : points) Insert(p);
}

ReferencePointSet::ReferencePointSet(const Volume& volume)
    : ReferencePointSet(std::span<const LatticePoint>(volume.SortedPoints())) {}

bool ReferencePointSet::InBox(LatticePoint p) const {
  return p.x >= low_.x && p.y >= low_.y && p.z >= low_.z && p.x <= high_.x && p.y <= high_.y &&
         p.z <= high_.z;
}

size_t ReferencePointSet::Index(LatticePoint p) const {
  const auto length = [](int32_t from, int32_t to) { return static_cast<size_t>(to - from); };
  const size_t width = length(low_.x, high_.x) + 1;
  const size_t depth = length(low_.y, high_.y) + 1;
  return (length(low_.z, p.z) * depth + length(low_.y, p.y)) * width + length(low_.x, p.x);
}

NeighborMask ReferencePointSet::NeighborsOf(LatticePoint p) const {
  unsigned mask = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if (Contains(p + Direction(bit).offset())) mask |= 1u << bit;
  }
  return static_cast<NeighborMask>(mask);
}

std::vector<LatticePoint> ReferencePointSet::SortedPoints() const {
  std::vector<LatticePoint> points;
  ForEachLatticePointOfBox([&](LatticePoint p) {
    if (Contains(p)) points.push_back(p);
  });
  return points;
}

}  // namespace bccskel::test
