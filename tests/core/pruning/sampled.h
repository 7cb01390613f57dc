#ifndef BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_
#define BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>

#include "core/skeleton/skeleton_graph.h"
#include "tests/support/volume_where.h"

namespace bccskel::test {

// Where a point of a cube of cells lies in the frame of a solid that is turned about the cube's
// middle, its origin.
inline WorldPoint InFrame(LatticePoint p, int32_t cells, double turn) {
  const double c = std::cos(turn), s = std::sin(turn);
  const double x = p.x - cells, y = p.y - cells, z = p.z - cells;
  const double once = s * x + c * y;
  return {c * x - s * y, c * once - s * z, s * once + c * z};
}

// The points of the cube that lie in the solid.
inline Volume Sampled(const std::function<bool(const WorldPoint&)>& contains, int32_t cells,
                      double turn) {
  return VolumeWhere({cells, cells, cells}, [&](int32_t i, int32_t j, int32_t k) {
    return contains(InFrame({i, j, k}, cells, turn));
  });
}

// The distance from a place of the solid to the nearest end of its skeleton, in lattice units.
inline double GapAt(const WorldPoint& place, const SkeletonGraph& graph, int32_t cells,
                    double turn) {
  double gap = std::numeric_limits<double>::infinity();
  for (const SkeletonNode& node : graph.nodes) {
    if (node.kind != NodeKind::kEnd) continue;
    gap = std::min(gap, DistanceBetween(place, InFrame(node.at.point, cells, turn)));
  }
  return gap;
}

// The distance to the surface of a limb whose radius changes from `at_a` to `at_b`, less inside.
inline double ToLimb(const WorldPoint& p, const WorldPoint& a, double at_a, const WorldPoint& b,
                     double at_b) {
  WorldPoint axis, way;
  double square = 0, along = 0;
  for (size_t n = 0; n < 3; ++n) {
    axis[n] = b[n] - a[n];
    way[n] = p[n] - a[n];
    square += axis[n] * axis[n];
    along += axis[n] * way[n];
  }
  const double part = square == 0 ? 0 : std::clamp(along / square, 0.0, 1.0);
  const WorldPoint nearest = {a[0] + part * axis[0], a[1] + part * axis[1], a[2] + part * axis[2]};
  return DistanceBetween(p, nearest) - (at_a + part * (at_b - at_a));
}

// Of two distances, to the solid in which a fillet joins the two.
inline double Joined(double a, double b, double fillet) {
  const double h = std::max(fillet - std::abs(a - b), 0.0) / fillet;
  return std::min(a, b) - h * h * fillet / 4;
}

}  // namespace bccskel::test

#endif  // BCCSKEL_TESTS_CORE_PRUNING_SAMPLED_H_
