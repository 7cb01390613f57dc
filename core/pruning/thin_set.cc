#include "core/pruning/thin_set.h"

#include <algorithm>
#include <bit>

#include "core/certificate/neighbor_planes.h"
#include "core/exec/stop_poll.h"

namespace bccskel {

ThinSet::ThinSet(const ThinCurves& curves, const exec::Context& context)
    : scale_(AxisScaleOf(curves.thin.placement())) {
  const Volume& thin = curves.thin;
  StopPoll poll(context);
  points_.Reserve(curves.radii.size());
  size_t n = 0;
  for (BrickIndex brick = 0; brick < thin.brick_count() && !poll.Stopped(); ++brick) {
    const BrickCoordinates at = thin.keys()[brick].coordinates();
    const NeighborPlanes planes = NeighborPlanesOf(thin, brick);
    thin.bricks()[brick].ForEachSetBit([&](int bit) {
      const int32_t birth = curves.births.empty() ? 0 : curves.births[n];
      points_.Set(PointOf(at, bit), {curves.radii[n], birth, NeighborsAt(bit, planes)});
      ++n;
    });
  }
}

int ThinSet::Degree(LatticePoint p) const {
  return std::popcount(static_cast<unsigned>(NeighborsOf(p)));
}

NeighborMask ThinSet::NeighborsAround(LatticePoint p) const {
  NeighborMask mask = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if (Contains(p + d.offset())) mask |= d.mask();
  }
  return mask;
}

void ThinSet::Add(LatticePoint p, float radius) {
  const NeighborMask neighbors = NeighborsAround(p);
  points_.Set(p, {radius, 0, neighbors});
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if ((neighbors & d.mask()) == 0) continue;
    points_.Find(p + d.offset())->neighbors |= d.Opposite().mask();
  }
}

void ThinSet::Remove(LatticePoint p) {
  const NeighborMask neighbors = NeighborsOf(p);
  points_.Remove(p);
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if ((neighbors & d.mask()) == 0) continue;
    NeighborMask& mask = points_.Find(p + d.offset())->neighbors;
    mask = static_cast<NeighborMask>(mask & ~d.Opposite().mask());
  }
}

std::vector<LatticePoint> ThinSet::Ends() const {
  std::vector<LatticePoint> ends;
  points_.ForEach([&](LatticePoint p, const Entry& entry) {
    if (std::has_single_bit(entry.neighbors)) ends.push_back(p);
  });
  std::ranges::sort(ends);
  return ends;
}

Volume ThinSet::ToVolume(const Volume& thin) const {
  VolumeBuilder builder(thin.extent(), thin.placement());
  ForEachPoint([&](LatticePoint p) { builder.Add(p); });
  return *std::move(builder).Build();
}

std::vector<float> ThinSet::RadiiOf(const Volume& volume) const {
  std::vector<float> radii;
  volume.ForEachPoint([&](LatticePoint p) { radii.push_back(RadiusOf(p)); });
  return radii;
}

}  // namespace bccskel
