#include "core/skeleton/curve_smoothing.h"

#include <algorithm>

namespace bccskel {
namespace {

constexpr size_t kReach = 4;

}  // namespace

CurveShape ShapeOf(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  const bool closed = edge.source == edge.target && edge.point_count > 2 &&
                      graph.nodes[edge.source].kind == NodeKind::kLoop;
  return closed ? CurveShape::kClosed : CurveShape::kOpen;
}

MeanRange RangeOfMean(size_t size, size_t n, CurveShape shape) {
  if (shape == CurveShape::kClosed) {
    const size_t once = size - 1, reach = std::min(kReach, (once - 1) / 4);
    return {n + once - reach, 2 * reach + 1, once};
  }
  const size_t reach = std::min({kReach, n, size - 1 - n});
  return {n - reach, 2 * reach + 1, size};
}

std::vector<Coordinates> MeansAlong(std::span<const Coordinates> values, CurveShape shape) {
  std::vector<Coordinates> means(values.size());
  for (size_t n = 0; n < values.size(); ++n) {
    means[n] = MeanAt([&](size_t k) { return values[k]; }, values.size(), n, shape);
  }
  return means;
}

}  // namespace bccskel
