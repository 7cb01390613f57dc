#include "core/skeleton/center_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <variant>
#include <vector>

#include "core/distance/exact_radius.h"
#include "core/distance/places.h"
#include "core/distance/points_along.h"
#include "core/exec/stop_poll.h"
#include "core/skeleton/curve_smoothing.h"

namespace bccskel {
namespace {

constexpr int kRings = 3;  // of samples from the curve to the rim of the disc
static_assert(2 * kRings + 1 <= PointsAlong::kCount);
constexpr double kLeastStep = 1;  // between samples, in lattice units
constexpr size_t kPointsAtOnce = 1024;
constexpr size_t kPointWork = 16;    // in the unit of Context::WorkersFor()
constexpr size_t kTangentReach = 2;  // points on either side that give the curve's way

class DiscCenters {
 public:
  // `radius` is of the same object and field.
  DiscCenters(const Volume& object, const DistanceField& field, const ExactRadius& radius)
      : field_(field), scale_(AxisScaleOf(object.placement())), bricks_(object), radius_(radius) {}

  Coordinates PlaceOf(LatticePoint p) const { return bccskel::PlaceOf(p, scale_); }

  // The way from `middle` to the center of the disc across `way` around it, along the disc.
  Coordinates WayToCenter(const Coordinates& middle, const Coordinates& way, double radius) {
    if (radius_.searches()) {
      const auto square_at = [&](LatticePoint p) { return radius_.SquaredAt(p); };
      return WayToCenter(square_at, middle, way, radius);
    }
    return std::visit(
        [&](const auto& squares) {
          const auto square_at = [&](LatticePoint p) {
            const BrickAddress address = AddressOf(p);
            const size_t brick = bricks_.Find(address.brick);
            return squares[brick * kBrickPoints + static_cast<size_t>(address.bit)];
          };
          return WayToCenter(square_at, middle, way, radius);
        },
        field_.values());
  }

  std::array<int16_t, 3> ShiftOf(const Coordinates& way) const {
    std::array<int16_t, 3> shift;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double units = std::nearbyint(way[axis] / scale_[axis] * kShiftUnits);
      shift[axis] = static_cast<int16_t>(std::clamp(units, -32767.0, 32767.0));
    }
    return shift;
  }

 private:
  template <typename SquareAt>
  Coordinates WayToCenter(SquareAt square_at, const Coordinates& middle, const Coordinates& way,
                          double radius) {
    const double step = std::max(radius / kRings, kLeastStep);
    const int rings = static_cast<int>(radius / step);
    const auto [u, v] = Across(way);
    Coordinates sum = {0, 0, 0};
    double weights = 0;
    for (int i = -rings; i <= rings; ++i) {
      const PointsAlong row = FindPointsAlong(Sum(middle, i * step, u), v, -rings, step, scale_);
      for (int j = -rings; j <= rings; ++j) {
        if (i * i + j * j > rings * rings) continue;
        const LatticePoint p = row[static_cast<size_t>(j + rings)];
        const double distance = std::sqrt(static_cast<double>(square_at(p)));
        const double weight = distance * distance;
        sum = Sum(sum, weight, Sum(PlaceOf(p), -1, middle));
        weights += weight;
      }
    }
    if (weights == 0) return {0, 0, 0};
    const Coordinates center = Times(1 / weights, sum);
    return Sum(center, -Dot(center, way), way);
  }

  const DistanceField& field_;
  const AxisScale scale_;
  NearbyBricks bricks_;
  ExactRadius radius_;
};

// A part of the smooth curve of one edge: shares of a long edge cost what their points cost.
class SmoothPart {
 public:
  // The places from `begin` to `end` of the edge.
  SmoothPart(const DiscCenters& centers, std::span<const SkeletonPoint> points, CurveShape shape,
             size_t begin, size_t end)
      : begin_(begin) {
    const auto place_at = [&](size_t k) { return centers.PlaceOf(points[k].point); };
    const size_t once = points.size() - 1;
    for (size_t n = begin; n < end + 2 * kTangentReach; ++n) {  // so many places farther on
      const size_t k = shape == CurveShape::kClosed
                           ? (n + once - std::min(once, kTangentReach)) % once
                           : std::min(std::max(n, kTangentReach) - kTangentReach, once);
      places_.push_back(MeanAt(place_at, points.size(), k, shape));
    }
  }

  const Coordinates& At(size_t n) const { return places_[n - begin_ + kTangentReach]; }
  // The way of the curve, of length 1; none where it stands still.
  Coordinates WayAt(size_t n) const {
    const Coordinates way = Sum(At(n + kTangentReach), -1, At(n - kTangentReach));
    return LengthOf(way) == 0 ? way : Unit(way);
  }

 private:
  const size_t begin_;
  std::vector<Coordinates> places_;  // from kTangentReach before `begin_` on
};

// Those of the edge's points that are among `mine`. The first and the last point of an open curve
// are its nodes' and stay.
void CenterEdge(DiscCenters& centers, const SkeletonEdge& edge, exec::Share mine, StopPoll& poll,
                SkeletonGraph& graph) {
  const CurveShape shape = ShapeOf(graph, edge);
  const size_t skip = shape == CurveShape::kClosed ? 0 : 1, first = edge.first_point;
  const size_t begin = std::max(mine.begin, first + skip);
  const size_t end = std::min(mine.end, first + edge.point_count - skip);
  if (begin >= end) return;
  const SmoothPart curve(centers, graph.PointsOf(edge), shape, begin - first, end - first);
  for (size_t at = begin; at < end && !poll.Stopped(); ++at) {
    const Coordinates way = curve.WayAt(at - first);
    if (Dot(way, way) == 0) continue;
    SkeletonPoint& p = graph.points[at];
    p.shift = centers.ShiftOf(centers.WayToCenter(curve.At(at - first), way, p.radius));
  }
}

// The first edge with a point at this position of SkeletonGraph::points or behind it.
std::vector<SkeletonEdge>::const_iterator FirstEdgeAt(const SkeletonGraph& graph, size_t position) {
  const auto end_of = [](const SkeletonEdge& edge) { return edge.first_point + edge.point_count; };
  return std::ranges::upper_bound(graph.edges, position, {}, end_of);
}

}  // namespace

absl::Status CenterCurves(const Volume& object, const DistanceField& field,
                          const exec::Context& context, SkeletonGraph& graph) {
  const ExactRadius radius(object, field);
  const int workers = context.WorkersFor(graph.points.size(), kPointWork);
  return context.ForEachShare(workers, graph.points.size(), kPointsAtOnce, [&](int) {
    return [&, centers = DiscCenters(object, field, radius),
            poll = StopPoll(context)](exec::Share mine) mutable {
      for (auto edge = FirstEdgeAt(graph, mine.begin);
           edge != graph.edges.end() && edge->first_point < mine.end; ++edge) {
        CenterEdge(centers, *edge, mine, poll, graph);
      }
    };
  });
}

}  // namespace bccskel
