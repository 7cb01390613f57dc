#include "client/view/first_view.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>

namespace bccskel::view {
namespace {

// The three-quarter view, in degrees.
constexpr double kTurn = 30, kClimb = 15;

WorldPoint Combine(double s, const WorldPoint& a, double t, const WorldPoint& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

// Across z, x and y.
constexpr std::array<View, 3> kSides = {{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                         {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}},
                                         {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}}}};

View BroadsideOf(const WorldBox& box) {
  std::array<double, 3> size;
  for (size_t axis = 0; axis < 3; ++axis) size[axis] = box.high[axis] - box.low[axis];
  if (size[2] <= size[0] && size[2] <= size[1]) return kSides[0];
  return kSides[size[0] <= size[1] ? 1 : 2];
}

// The square of the area that the points fill in a view, but for a factor that depends on how they
// are distributed.
double SquaredAreaIn(const View& view, std::span<const WorldPoint> points) {
  const size_t step = points.size() / 20'000 + 1;  // some thousands suffice
  double count = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (size_t n = 0; n < points.size(); n += step) {
    const WorldPoint p = {points[n][0] - points[0][0], points[n][1] - points[0][1],
                          points[n][2] - points[0][2]};
    const double right = Dot(view.right, p), up = Dot(view.up, p);
    count += 1;
    x += right;
    y += up;
    xx += right * right;
    xy += right * up;
    yy += up * up;
  }
  const auto variance = [&](double square, double a, double b) {
    return square / count - a / count * b / count;
  };
  return variance(xx, x, x) * variance(yy, y, y) - variance(xy, x, y) * variance(xy, x, y);
}

// A flat object that lies obliquely in its box might show its edge: then it is seen from the side
// where it covers most.
Front ThreeQuarterFrontOf(const WorldBox& box, std::span<const WorldPoint> points) {
  constexpr double kMuchMore = 2;
  Front best = {BroadsideOf(box), kTurn, kClimb};
  const auto area = [&](const View& side, double turn) {
    return SquaredAreaIn(ViewFrom(side, turn, kClimb), points);
  };
  double most = kMuchMore * area(best.view, kTurn);
  for (const View& side : kSides) {
    for (const double turn : {kTurn, -kTurn}) {
      const double here = area(side, turn);
      if (!(here > most)) continue;  // no points
      most = here;
      best = {side, turn, kClimb};
    }
  }
  return best;
}

std::string_view OptionOf(const ResultDocument& result, std::string_view name) {
  const auto option =
      std::ranges::find(result.options, name, [](const auto& o) { return o.first; });
  return option == result.options.end() ? std::string_view() : option->second;
}

std::optional<SliceFacts> SliceFactsOf(const ResultDocument& result) {
  if (OptionOf(result, "source") != "voxels" || !result.placement.has_value()) return std::nullopt;
  const std::string_view slabs = OptionOf(result, "voxel_slabs");  // x,y,z
  int z = 1;
  const size_t comma = slabs.rfind(',') + 1;
  std::from_chars(slabs.data() + comma, slabs.data() + slabs.size(), z);
  return SliceFacts{result.placement->spacing[2], z, result.world};
}

}  // namespace

WorldBox BoxOf(std::span<const WorldPoint> points) {
  if (points.empty()) return {{0, 0, 0}, {0, 0, 0}};
  WorldBox box = {points.front(), points.front()};
  for (const WorldPoint& p : points) {
    for (size_t axis = 0; axis < 3; ++axis) {
      box.low[axis] = std::min(box.low[axis], p[axis]);
      box.high[axis] = std::max(box.high[axis], p[axis]);
    }
  }
  return box;
}

Front FrontOf(const WorldBox& box, std::span<const WorldPoint> points,
              const std::optional<SliceFacts>& slice) {
  // Points of one slice lie on both of its faces; the box is half a step larger, and another half
  // is left for rounding. Boxes that look as flat count, too.
  constexpr double kMoreSteps = 1.5, kFlat = 0.02;
  const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1];
  const double z = box.high[2] - box.low[2];
  const bool flat =
      slice.has_value() && z <= std::min(x, y) &&
      z <= std::max((slice->slabs + kMoreSteps) * slice->step, kFlat * std::min(x, y));
  if (!flat) return ThreeQuarterFrontOf(box, points);
  const bool anterior = slice->axes.size() == 3 && slice->axes[1] == 'A';
  if (anterior) return {BroadsideOf(box), 0, 0};
  return {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, 0, 0};
}

std::vector<WorldPoint> ShownPoints(const ResultDocument& result,
                                    std::span<const WorldPoint> surface) {
  std::vector<WorldPoint> points(surface.begin(), surface.end());
  if (!points.empty()) return points;
  points = result.sheets.points;
  for (const ResultDocument::Node& node : result.nodes) points.push_back(node.position);
  points.insert(points.end(), result.points.begin(), result.points.end());
  return points;
}

Front FrontOf(const ResultDocument& result, std::span<const WorldPoint> surface) {
  if (surface.empty()) {
    const std::vector<WorldPoint> points = ShownPoints(result, surface);
    return FrontOf(BoxOf(points), points, std::nullopt);  // a flat curve is no slice
  }
  return FrontOf(BoxOf(surface), surface, SliceFactsOf(result));
}

View ViewFrom(const View& front, double turn, double climb) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double cos_turn = std::cos(turn * kRadians), sin_turn = std::sin(turn * kRadians);
  const double cos_climb = std::cos(climb * kRadians), sin_climb = std::sin(climb * kRadians);
  const WorldPoint level = Combine(cos_turn, front.toward, sin_turn, front.right);
  return {Combine(cos_turn, front.right, -sin_turn, front.toward),
          Combine(cos_climb, front.up, -sin_climb, level),
          Combine(cos_climb, level, sin_climb, front.up)};
}

std::array<View, 3> ViewsOf(const Front& front) {
  const auto& [view, turn, climb] = front;
  const bool straight = turn == 0 && climb == 0;
  return {ViewFrom(view, turn, climb), ViewFrom(view, 90, 0),
          straight ? ViewFrom(view, kTurn, kClimb) : ViewFrom(view, 0, 90)};
}

}  // namespace bccskel::view
