#ifndef BCCSKEL_TESTS_CORE_PRUNING_SIMPLE_NOISE_H_
#define BCCSKEL_TESTS_CORE_PRUNING_SIMPLE_NOISE_H_

#include <algorithm>
#include <random>
#include <vector>

#include "core/pruning/thin_set.h"
#include "core/topology/neighborhood.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// Noise that keeps the topology: about `fraction` of the points on either side of the boundary
// change sides, one by one, and only where they are simple at their turn.
inline Volume WithSimpleNoise(const Volume& object, double fraction, uint64_t seed) {
  PointSet points;
  object.ForEachPoint([&](LatticePoint p) { points.insert(p); });
  const auto neighbors_of = [&](LatticePoint p) {
    NeighborMask mask = 0;
    for (size_t bit = 0; bit < kDirections14.size(); ++bit) {
      if (points.contains(p + kDirections14[bit])) mask |= static_cast<NeighborMask>(1u << bit);
    }
    return mask;
  };
  std::vector<LatticePoint> boundary;
  object.ForEachPoint([&](LatticePoint p) {
    if (neighbors_of(p) == kAllNeighbors) return;
    boundary.push_back(p);
    for (LatticePoint offset : kDirections14) {
      if (!points.contains(p + offset)) boundary.push_back(p + offset);
    }
  });
  std::ranges::sort(boundary);
  boundary.erase(std::unique(boundary.begin(), boundary.end()), boundary.end());
  std::mt19937_64 random(seed);
  for (LatticePoint p : boundary) {
    const bool chosen = static_cast<double>(random() >> 11) * 0x1p-53 < fraction;
    if (!chosen || !object.extent().Contains(p) || !IsSimple(neighbors_of(p))) continue;
    if (points.erase(p) == 0) points.insert(p);
  }
  VolumeBuilder builder(object.extent(), object.placement());
  for (LatticePoint p : points) builder.Add(p);
  return *std::move(builder).Build();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PRUNING_SIMPLE_NOISE_H_
