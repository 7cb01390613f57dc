#include "core/pruning/way_on.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/lattice/directions.h"

namespace bccskel {
namespace {

constexpr size_t kAimPoints = 10;         // the way on is that of the last points
constexpr double kLeastStepCosine = 0.4;  // cosine between it and a step
constexpr double kAimWeight = 0.5;        // against the rise of the radius

}  // namespace

WayOn::WayOn(const Volume& object, const ExactRadius& radius)
    : scale_(AxisScaleOf(object.placement())), bricks_(object), radius_(radius) {}

void WayOn::Append(BranchPath& path) {
  const size_t last = path.points.size() - 1;
  const Coordinates end = PlaceOf(path.points[last], scale_);
  const Coordinates back = PlaceOf(path.points[last - std::min(last, kAimPoints)], scale_);
  const Coordinates aim = Unit(Sum(end, -1, back));
  const double largest = path.radii[last] + kLargestRise;
  while (true) {
    const LatticePoint at = path.points.back();
    std::optional<Step> best;
    for (const LatticePoint& direction : kDirections14) {
      const LatticePoint to = at + direction;
      const Coordinates step = PlaceOf(direction, scale_);
      const double length = std::sqrt(Dot(step, step)), cosine = Dot(step, aim) / length;
      if (cosine < kLeastStepCosine || !bricks_.Contains(to)) continue;
      const Coordinates way = Sum(PlaceOf(to, scale_), -1, end);
      if (Dot(way, way) > kLongest * kLongest) continue;
      const float radius = radius_.At(to);
      const double score = (radius - path.radii.back()) / length + kAimWeight * cosine;
      if (!best.has_value() || score > best->score) best = Step{to, radius, score};
    }
    if (!best.has_value() || best->radius > largest) return;
    path.points.push_back(best->to);
    path.radii.push_back(best->radius);
  }
}

}  // namespace bccskel
