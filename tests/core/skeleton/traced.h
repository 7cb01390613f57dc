#ifndef BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_
#define BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_

#include <cstdint>
#include <functional>
#include <variant>
#include <vector>

#include "core/skeleton/skeleton_graph.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// A made-up distance for each point: 1 when nothing else is said.
using Depth = std::function<uint16_t(LatticePoint)>;

inline DistanceField FieldOf(
    const Volume& object, const Depth& depth = [](LatticePoint) -> uint16_t { return 1; }) {
  std::variant_alternative_t<0, DistanceField::Values> values;
  values.assign(object.brick_count() * kBrickPoints, 0);
  for (size_t n = 0; n < object.brick_count(); ++n) {
    object.bricks()[n].ForEachSetBit([&](int bit) {
      values[n * kBrickPoints + static_cast<size_t>(bit)] =
          depth(PointOf(object.keys()[n].coordinates(), bit));
    });
  }
  return DistanceField(DistanceKind::kChamfer, kShortChamfer, std::move(values), 1);
}

// Some depth that differs from point to point.
inline uint16_t RuggedDepth(LatticePoint p) {
  const auto hash = static_cast<uint32_t>(p.x * 73 + p.y * 151 + p.z * 283);
  return static_cast<uint16_t>(181 + hash % 17);
}

inline SkeletonGraph Trace(const std::vector<LatticePoint>& points) {
  const Volume volume = VolumeOfPoints(points);
  return TraceSkeleton(volume, volume, FieldOf(volume), {}).value();
}

inline SkeletonGraph Trace(const std::vector<LatticePoint>& points, const Depth& depth) {
  const Volume volume = VolumeOfPoints(points);
  return TraceSkeleton(volume, volume, FieldOf(volume, depth), {}).value();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_
