#ifndef BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_
#define BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/skeleton/skeleton_graph.h"

namespace bccskel {

// Closed curves have no junction; their first and last point are the same.
enum class CurveShape : uint8_t { kOpen, kClosed };
CurveShape ShapeOf(const SkeletonGraph& graph, const SkeletonEdge& edge);

// The values whose mean replaces value n of `size`: [first, first + count), modulo `period` on a
// closed curve.
struct MeanRange {
  size_t first;
  size_t count;
  size_t period;
};
MeanRange RangeOfMean(size_t size, size_t n, CurveShape shape);

// The mean of value n of a curve and up to four values on either side. The first and last value of
// an open curve do not change. `value_at(n)` returns a value.
template <typename ValueAt>
Coordinates MeanAt(ValueAt value_at, size_t size, size_t n, CurveShape shape) {
  const MeanRange range = RangeOfMean(size, n, shape);
  Coordinates mean = {0, 0, 0};
  for (size_t k = range.first; k < range.first + range.count; ++k) {
    const Coordinates value = value_at(k % range.period);
    for (size_t axis = 0; axis < 3; ++axis) mean[axis] += value[axis];
  }
  for (double& coordinate : mean) coordinate /= static_cast<double>(range.count);
  return mean;
}

// MeanAt() for each value along a curve.
std::vector<Coordinates> MeansAlong(std::span<const Coordinates> values, CurveShape shape);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_
