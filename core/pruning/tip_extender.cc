#include "core/pruning/tip_extender.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/lattice/directions.h"

namespace bccskel {
namespace {

constexpr size_t kAimPoints = 10;         // the aim is the direction of the last ten points
constexpr double kLeastStepCosine = 0.4;  // between the aim and a step
constexpr double kAimWeight = 0.5;        // weight of that cosine against the rise of the radius
constexpr double kLeastSheet = 3;         // radius in steps of the surface
constexpr double kThickerRoot = 1.3;      // least radius of the junction, in radii of the sheet
constexpr double kSheetStep = 2;          // lattice units
constexpr double kSheetSlope = 0.25;      // the largest fall of the radius per unit
constexpr double kLongestSheet = 400;     // lattice units
constexpr size_t kWayReach = 5;           // points on either side that give a path's direction
constexpr double kBorderMargin = 1;       // lattice units
constexpr double kBorderCosine = 0.7;  // least cosine between the path and the way out of the image
constexpr double kRadiiBeyond = 2;     // length of the extension

}  // namespace

TipExtender::TipExtender(const Volume& object, const ExactRadius& radius, double surface_step)
    : scale_(AxisScaleOf(object.placement())),
      surface_step_(surface_step),
      bricks_(object),
      radius_(radius) {}

void TipExtender::Append(BranchPath& path) {
  if (surface_step_ != 1) return;
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
      const double length = LengthOf(step), cosine = Dot(step, aim) / length;
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

void TipExtender::AppendOverSheet(BranchPath& path) {
  const Coordinates end = PlaceOf(path.points.back(), scale_);
  const Coordinates way = DirectionAt(path.points, path.points.size() - 1, scale_);
  const float radius = path.radii.back();
  if (radius < kLeastSheet * surface_step_ || path.radii[0] < kThickerRoot * radius + 0.5) return;
  for (double out = kSheetStep; out <= kLongestSheet; out += kSheetStep) {
    const LatticePoint to = PointNear(Sum(end, out, way), scale_);
    if (!bricks_.Contains(to)) return;
    const float there = radius_.At(to);
    if (there < radius - kSheetSlope * out || there > radius + kLargestRise) return;
    path.points.push_back(to);
    path.radii.push_back(there);
  }
}

Coordinates DirectionAt(std::span<const LatticePoint> path, size_t n, const AxisScale& scale) {
  const LatticePoint from = path[n - std::min(n, kWayReach)];
  const LatticePoint to = path[std::min(n + kWayReach, path.size() - 1)];
  return Unit(WayBetween(from, to, scale));
}

bool ExtendAcrossBorder(const std::optional<LatticeBox>& image, const AxisScale& scale,
                        BranchPath& path) {
  if (!image.has_value() || path.points.size() < 2) return false;
  const LatticePoint end = path.points.back(), low = image->low, high = image->high;
  const Coordinates way = DirectionAt(path.points, path.points.size() - 1, scale);
  const float radius = path.radii.back();
  const auto leaves = [&](size_t axis, int32_t before, int32_t after) {
    const double reach = (radius + kBorderMargin) / scale[axis];
    return (before <= reach && way[axis] <= -kBorderCosine) ||
           (after <= reach && way[axis] >= kBorderCosine);
  };
  if (!leaves(0, end.x - low.x, high.x - end.x) && !leaves(1, end.y - low.y, high.y - end.y) &&
      !leaves(2, end.z - low.z, high.z - end.z)) {
    return false;
  }
  path.points.push_back(PointNear(Sum(PlaceOf(end, scale), kRadiiBeyond * radius, way), scale));
  path.radii.push_back(radius);
  return true;
}

}  // namespace bccskel
