#include "core/skeleton/center_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <vector>

#include "core/distance/places.h"
#include "core/exec/stop_poll.h"
#include "core/skeleton/curve_smoothing.h"

namespace bccskel {
namespace {

constexpr int kRings = 3;         // of samples from the curve to the rim of the disc
constexpr double kLeastStep = 1;  // between samples, in lattice units
constexpr size_t kPointsAtOnce = 1024;
constexpr size_t kPointWork = 16;    // in the unit of Context::WorkersFor()
constexpr size_t kTangentReach = 2;  // points on either side that give the curve's way

class DiscCenters {
 public:
  DiscCenters(const Volume& object, const DistanceField& field)
      : object_(object), field_(field), scale_(AxisScaleOf(object.placement())), bricks_(object) {}

  Coordinates PlaceOf(LatticePoint p) const { return bccskel::PlaceOf(p, scale_); }

  // The way from `middle` to the center of the disc across `way` around it, along the disc.
  Coordinates WayToCenter(const Coordinates& middle, const Coordinates& way, double radius) {
    const double step = std::max(radius / kRings, kLeastStep);
    const int rings = static_cast<int>(radius / step);
    const auto [u, v] = Across(way);
    Coordinates sum = {0, 0, 0};
    double weights = 0;
    for (int i = -rings; i <= rings; ++i) {
      for (int j = -rings; j <= rings; ++j) {
        if (i * i + j * j > rings * rings) continue;
        const LatticePoint p = PointNear(Sum(Sum(middle, i * step, u), j * step, v), scale_);
        const double weight = SquaredDistance(p);
        sum = Sum(sum, weight, Sum(PlaceOf(p), -1, middle));
        weights += weight;
      }
    }
    if (weights == 0) return {0, 0, 0};
    const Coordinates center = Sum({0, 0, 0}, 1 / weights, sum);
    return Sum(center, -Dot(center, way), way);
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
  double SquaredDistance(LatticePoint p) {
    if (!object_.extent().Contains(p)) return 0;
    const BrickAddress address = AddressOf(p);
    const std::optional<BrickIndex> brick = bricks_.Find(address.brick);
    if (!brick.has_value()) return 0;
    const double distance = field_.ToLatticeUnits(field_.At(*brick, address.bit));
    return distance * distance;
  }

  const Volume& object_;
  const DistanceField& field_;
  const AxisScale scale_;
  NearbyBricks bricks_;
};

// The way of the curve at a place, of length 1; none where it stands still.
Coordinates WayAt(std::span<const Coordinates> curve, size_t n, CurveShape shape) {
  size_t before = n - std::min(n, kTangentReach);
  size_t after = std::min(n + kTangentReach, curve.size() - 1);
  if (shape == CurveShape::kClosed) {
    const size_t once = curve.size() - 1;
    before = (n + once - std::min(once, kTangentReach)) % once;
    after = (n + kTangentReach) % once;
  }
  const Coordinates way = Sum(curve[after], -1, curve[before]);
  const double length = std::sqrt(Dot(way, way));
  return length == 0 ? way : Sum({0, 0, 0}, 1 / length, way);
}

// Those of the edge's points that are among `mine`. The first and the last point of an open curve
// are its nodes' and stay.
void CenterEdge(DiscCenters& centers, const SkeletonEdge& edge, exec::Share mine, StopPoll& poll,
                SkeletonGraph& graph) {
  const CurveShape shape = ShapeOf(graph, edge);
  const std::span<SkeletonPoint> points =
      std::span(graph.points).subspan(edge.first_point, edge.point_count);
  std::vector<Coordinates> places;
  for (const SkeletonPoint& p : points) places.push_back(centers.PlaceOf(p.point));
  const std::vector<Coordinates> curve = MeansAlong(places, shape);
  const size_t skip = shape == CurveShape::kClosed ? 0 : 1;
  for (size_t n = skip; n + skip < points.size() && !poll.Stopped(); ++n) {
    const size_t at = edge.first_point + n;
    const Coordinates way = WayAt(curve, n, shape);
    if (at < mine.begin || at >= mine.end || Dot(way, way) == 0) continue;
    points[n].shift = centers.ShiftOf(centers.WayToCenter(curve[n], way, points[n].radius));
  }
}

}  // namespace

absl::Status CenterCurves(const Volume& object, const DistanceField& field,
                          const exec::Context& context, SkeletonGraph& graph) {
  const int workers = context.WorkersFor(graph.points.size(), kPointWork);
  exec::Portions portions(graph.points.size(), kPointsAtOnce);
  context.Offer(workers, [&](int) {
    DiscCenters centers(object, field);
    StopPoll poll(context);
    for (exec::Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
      for (const SkeletonEdge& edge : graph.edges) {
        if (edge.first_point >= mine.end || edge.first_point + edge.point_count <= mine.begin)
          continue;
        if (poll.StoppedNow()) return;
        CenterEdge(centers, edge, mine, poll, graph);
      }
    }
  });
  return context.StopStatus();
}

}  // namespace bccskel
