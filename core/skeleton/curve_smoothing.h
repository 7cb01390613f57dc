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

// The mean of value n of a curve and up to four values on either side, the two farthest of which
// count half. So it removes zigzags with a period of two or four points, which thinning leaves
// where the middle of a limb lies between lattice points. The first and last value of an open curve
// do not change. `value_at(n)` returns a value.
template <typename ValueAt>
Coordinates MeanAt(ValueAt value_at, size_t size, size_t n, CurveShape shape) {
  const MeanRange range = RangeOfMean(size, n, shape);
  const auto value = [&](size_t k) -> Coordinates {
    size_t at = range.first + k;
    while (at >= range.period) at -= range.period;  // twice at most, and faster than a division
    return value_at(at);
  };
  const size_t last = range.count - 1;
  if (last == 0) return value(0);
  Coordinates sum = Sum(Times(0.5, value(0)), 0.5, value(last));
  for (size_t k = 1; k < last; ++k) sum = Sum(sum, 1, value(k));
  return Times(1 / static_cast<double>(last), sum);
}

// MeanAt() for each value along a curve.
std::vector<Coordinates> MeansAlong(std::span<const Coordinates> values, CurveShape shape);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_SKELETON_CURVE_SMOOTHING_H_
