#ifndef BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_
#define BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "core/skeleton/skeleton_graph.h"
#include "core/volume/volume.h"

namespace bccskel::test {

// A made-up radius for each point: 1 when nothing else is said.
using Depth = std::function<float(LatticePoint)>;

inline std::vector<float> RadiiOf(
    const Volume& thin, const Depth& depth = [](LatticePoint) { return 1.0f; }) {
  std::vector<float> radii;
  thin.ForEachPoint([&](LatticePoint p) { radii.push_back(depth(p)); });
  return radii;
}

// Some depth that differs from point to point.
inline float RuggedDepth(LatticePoint p) {
  const auto hash = static_cast<uint32_t>(p.x * 73 + p.y * 151 + p.z * 283);
  return static_cast<float>(181 + hash % 17);
}

inline SkeletonGraph Trace(const std::vector<LatticePoint>& points) {
  const Volume volume = VolumeOfPoints(points);
  return TraceSkeleton({volume, RadiiOf(volume)}, {}).value();
}

inline SkeletonGraph Trace(const std::vector<LatticePoint>& points, const Depth& depth) {
  const Volume volume = VolumeOfPoints(points);
  return TraceSkeleton({volume, RadiiOf(volume, depth)}, {}).value();
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_SKELETON_TRACED_H_
