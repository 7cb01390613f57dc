#include "core/skeleton/skeleton_graph.h"

#include <cmath>

namespace bccskel {

double SkeletonGraph::RadiusOf(const SkeletonPoint& p) const {
  const double mean = (placement.spacing[0] + placement.spacing[1] + placement.spacing[2]) / 3;
  const double lattice_units = p.distance / weights.counts_per_unit;
  return lattice_units * mean / 2;  // spacing is the edge of the cell, two lattice units
}

double SkeletonGraph::LengthOf(const SkeletonEdge& edge) const {
  const std::span<const SkeletonPoint> path = PointsOf(edge);
  double length = 0;
  for (size_t n = 1; n < path.size(); ++n) {
    const WorldPoint a = PositionOf(path[n - 1]), b = PositionOf(path[n]);
    const double dx = b[0] - a[0], dy = b[1] - a[1], dz = b[2] - a[2];
    length += std::sqrt(dx * dx + dy * dy + dz * dz);
  }
  return length;
}

}  // namespace bccskel
