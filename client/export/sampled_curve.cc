#include "client/export/sampled_curve.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "core/distance/places.h"
#include "core/skeleton/skeleton_figures.h"

namespace bccskel::exporting {
namespace {

using Curve = std::vector<CurvePoint>;

// Limits the number of points for a tiny step.
constexpr double kMostPerPoint = 1000;
// Fewer would collapse a loop of one edge to a point or a line.
constexpr size_t kLeastStepsOfLoop = 4;

CurvePoint Mix(const CurvePoint& a, const CurvePoint& b, double part) {
  CurvePoint mixed = {a.at, a.radius + part * (b.radius - a.radius)};
  for (size_t axis = 0; axis < 3; ++axis) mixed.at[axis] += part * (b.at[axis] - a.at[axis]);
  return mixed;
}

// The same curve in `steps` steps of equal length. Needs: at least two points and one step.
Curve Resampled(const Curve& curve, size_t steps) {
  const std::vector<double> ways = WaysAlong(curve);
  Curve resampled;
  resampled.reserve(steps + 1);
  resampled.push_back(curve.front());
  size_t behind = 1;
  for (size_t n = 1; n < steps; ++n) {
    const double way = ways.back() * static_cast<double>(n) / static_cast<double>(steps);
    while (behind + 1 < curve.size() && ways[behind] < way) ++behind;
    const double length = ways[behind] - ways[behind - 1];
    const double part = length > 0 ? (way - ways[behind - 1]) / length : 0;
    resampled.push_back(Mix(curve[behind - 1], curve[behind], std::clamp(part, 0.0, 1.0)));
  }
  resampled.push_back(curve.back());
  return resampled;
}

double StepOf(const Placement& placement) {
  return 2 * std::ranges::min(placement.spacing) * CoarsenessOf(AxisScaleOf(placement));
}

Curve Sampled(const SkeletonGraph& graph, const SkeletonEdge& edge,
              std::span<const WorldPoint> smooth, const CurveSampling& sampling) {
  const std::span<const SkeletonPoint> points = graph.PointsOf(edge);
  Curve curve;
  curve.reserve(points.size());
  for (size_t n = 0; n < points.size(); ++n) {
    curve.push_back({smooth[n], graph.RadiusOf(points[n])});
  }
  if (curve.size() < 2) return curve;
  const double most = kMostPerPoint * static_cast<double>(curve.size());
  const double step = sampling.step.value_or(StepOf(graph.placement));
  const double wanted = std::round(WaysAlong(curve).back() / step);
  const size_t least = edge.source == edge.target ? kLeastStepsOfLoop : 1;
  return Resampled(curve, std::max(least, static_cast<size_t>(std::min(wanted, most))));
}

}  // namespace

std::vector<double> WaysAlong(const std::vector<CurvePoint>& curve) {
  std::vector<double> ways;
  ways.reserve(std::max<size_t>(curve.size(), 1));
  ways.push_back(0);
  for (size_t n = 1; n < curve.size(); ++n) {
    ways.push_back(ways.back() + DistanceBetween(curve[n - 1].at, curve[n].at));
  }
  return ways;
}

std::vector<CurvePoint> SampledCurve(const SkeletonGraph& graph, const SkeletonEdge& edge,
                                     const CurveSampling& sampling) {
  if (sampling.step != 0.0) return Sampled(graph, edge, SmoothCurve(graph, edge), sampling);
  Curve curve;
  for (const SkeletonPoint& p : graph.PointsOf(edge)) {
    curve.push_back({graph.PositionOf(p), graph.RadiusOf(p)});
  }
  return curve;
}

std::vector<CurvePoint> SampledCurve(const SkeletonGraph& graph, const SkeletonEdge& edge,
                                     std::span<const WorldPoint> smooth) {
  return Sampled(graph, edge, smooth, {});
}

}  // namespace bccskel::exporting
