#include "core/pruning/thin_set.h"

#include <algorithm>
#include <bit>

namespace bccskel {

ThinSet::ThinSet(const ThinCurves& curves) : scale_(AxisScaleOf(curves.thin.placement())) {
  points_.reserve(curves.radii.size());
  size_t n = 0;
  curves.thin.ForEachPoint([&](LatticePoint p) {
    points_.emplace(p, Entry{curves.radii[n], curves.births.empty() ? 0 : curves.births[n], 0});
    ++n;
  });
  for (auto& [p, entry] : points_) entry.neighbors = NeighborsAround(p);
}

int ThinSet::Degree(LatticePoint p) const {
  return std::popcount(static_cast<unsigned>(NeighborsOf(p)));
}

NeighborMask ThinSet::NeighborsAround(LatticePoint p) const {
  NeighborMask mask = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if (points_.contains(p + d.offset())) mask |= d.mask();
  }
  return mask;
}

void ThinSet::Add(LatticePoint p, float radius) {
  const NeighborMask neighbors = NeighborsAround(p);
  points_.emplace(p, Entry{radius, 0, neighbors});
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if ((neighbors & d.mask()) == 0) continue;
    points_.at(p + d.offset()).neighbors |= d.Opposite().mask();
  }
}

void ThinSet::Remove(LatticePoint p) {
  const NeighborMask neighbors = NeighborsOf(p);
  points_.erase(p);
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if ((neighbors & d.mask()) == 0) continue;
    NeighborMask& mask = points_.at(p + d.offset()).neighbors;
    mask = static_cast<NeighborMask>(mask & ~d.Opposite().mask());
  }
}

std::vector<LatticePoint> ThinSet::Ends() const {
  std::vector<LatticePoint> ends;
  for (const auto& [p, entry] : points_) {
    if (std::has_single_bit(entry.neighbors)) ends.push_back(p);
  }
  std::ranges::sort(ends);
  return ends;
}

Volume ThinSet::ToVolume(const Volume& thin) const {
  VolumeBuilder builder(thin.extent(), thin.placement());
  for (const auto& [p, entry] : points_) builder.Add(p);
  return *std::move(builder).Build();
}

std::vector<float> ThinSet::RadiiOf(const Volume& volume) const {
  std::vector<float> radii;
  volume.ForEachPoint([&](LatticePoint p) { radii.push_back(RadiusOf(p)); });
  return radii;
}

}  // namespace bccskel
