#include "core/skeleton/curve_smoothing.h"

#include <algorithm>

namespace bccskel {
namespace {

constexpr size_t kReach = 4;

// The mean of `count` values from `first` on, in a list that may close on itself.
Coordinates MeanOf(std::span<const Coordinates> values, size_t first, size_t count) {
  Coordinates mean = {0, 0, 0};
  for (size_t n = 0; n < count; ++n) {
    for (size_t axis = 0; axis < 3; ++axis) mean[axis] += values[(first + n) % values.size()][axis];
  }
  for (double& coordinate : mean) coordinate /= static_cast<double>(count);
  return mean;
}

std::vector<Coordinates> AlongOpen(std::span<const Coordinates> values) {
  std::vector<Coordinates> means(values.size());
  for (size_t n = 0; n < values.size(); ++n) {
    const size_t reach = std::min({kReach, n, values.size() - 1 - n});
    means[n] = MeanOf(values, n - reach, 2 * reach + 1);
  }
  return means;
}

std::vector<Coordinates> AlongClosed(std::span<const Coordinates> values) {
  const std::span<const Coordinates> once = values.first(values.size() - 1);
  const size_t reach = std::min(kReach, (once.size() - 1) / 4);
  std::vector<Coordinates> means(values.size());
  for (size_t n = 0; n < means.size(); ++n) {
    means[n] = MeanOf(once, n + once.size() - reach, 2 * reach + 1);
  }
  return means;
}

}  // namespace

CurveShape ShapeOf(const SkeletonGraph& graph, const SkeletonEdge& edge) {
  const bool closed = edge.source == edge.target && edge.point_count > 2 &&
                      graph.nodes[edge.source].kind == NodeKind::kLoop;
  return closed ? CurveShape::kClosed : CurveShape::kOpen;
}

std::vector<Coordinates> MeansAlong(std::span<const Coordinates> values, CurveShape shape) {
  return shape == CurveShape::kClosed ? AlongClosed(values) : AlongOpen(values);
}

}  // namespace bccskel
