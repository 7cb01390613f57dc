#include "core/labels/point_index.h"

#include <algorithm>
#include <utility>

namespace bccskel {
namespace {

constexpr size_t kLeaf = 8;

size_t WidestAxis(const std::vector<ValuePoint>& points, size_t begin, size_t end) {
  std::array<double, 3> low = points[begin].at, high = low;
  for (size_t n = begin; n < end; ++n) {
    for (size_t axis = 0; axis < 3; ++axis) {
      low[axis] = std::min(low[axis], points[n].at[axis]);
      high[axis] = std::max(high[axis], points[n].at[axis]);
    }
  }
  size_t widest = 0;
  for (size_t axis = 1; axis < 3; ++axis) {
    if (high[axis] - low[axis] > high[widest] - low[widest]) widest = axis;
  }
  return widest;
}

}  // namespace

PointIndex::PointIndex(std::vector<ValuePoint> points)
    : points_(std::move(points)), axes_(points_.size()) {
  Build(0, points_.size());
}

void PointIndex::Build(size_t begin, size_t end) {
  if (end - begin <= kLeaf) return;
  const size_t middle = (begin + end) / 2, axis = WidestAxis(points_, begin, end);
  const auto at = [this](size_t n) { return points_.begin() + static_cast<ptrdiff_t>(n); };
  std::nth_element(at(begin), at(middle), at(end),
                   [axis](const auto& a, const auto& b) { return a.at[axis] < b.at[axis]; });
  axes_[middle] = static_cast<uint8_t>(axis);
  Build(begin, middle);
  Build(middle + 1, end);
}

void PointIndex::Offer(const std::array<double, 3>& at, size_t point,
                       NearestCurvePoint& best) const {
  const std::array<double, 3>& p = points_[point].at;
  const double dx = at[0] - p[0], dy = at[1] - p[1], dz = at[2] - p[2];
  best.Offer(dx * dx + dy * dy + dz * dz, points_[point].value, point);
}

// `away` is how far the range lies from the place along each axis, at least. Rounding keeps order,
// so what it bounds is never nearer than the bound, ties included.
void PointIndex::Search(const std::array<double, 3>& at, size_t begin, size_t end,
                        const std::array<double, 3>& away, NearestCurvePoint& best) const {
  if (end - begin <= kLeaf) {
    for (size_t n = begin; n < end; ++n) Offer(at, n, best);
    return;
  }
  const size_t middle = (begin + end) / 2, axis = axes_[middle];
  const double across = at[axis] - points_[middle].at[axis];
  const bool below = across < 0;
  Search(at, below ? begin : middle + 1, below ? middle : end, away, best);
  Offer(at, middle, best);
  std::array<double, 3> far = away;
  far[axis] = across;
  // Points at the same distance may have a smaller value.
  if (far[0] * far[0] + far[1] * far[1] + far[2] * far[2] > best.squared) return;
  Search(at, below ? middle + 1 : begin, below ? end : middle, far, best);
}

NearestCurvePoint PointIndex::Find(const std::array<double, 3>& at, size_t hint) const {
  NearestCurvePoint best;
  Offer(at, hint, best);
  Search(at, 0, points_.size(), {}, best);
  return best;
}

}  // namespace bccskel
