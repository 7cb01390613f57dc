#include "client/export/picture/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bccskel::exporting {
namespace {

// The three-quarter view, in degrees.
constexpr double kTurn = 30, kClimb = 15;

WorldPoint Combine(double s, const WorldPoint& a, double t, const WorldPoint& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

// The extent along a unit vector.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double middle() const { return low / 2 + high / 2; }
};

Range RangeAlong(const WorldPoint& v, const Spheres& shown) {
  Range range;
  for (const WorldPoint& center : shown.centers) {
    const double place = Dot(v, center);
    range.low = std::min(range.low, place - shown.radius);
    range.high = std::max(range.high, place + shown.radius);
  }
  return range;
}

View BroadsideOf(const WorldBox& box) {
  std::array<double, 3> size;
  for (size_t axis = 0; axis < 3; ++axis) size[axis] = box.high[axis] - box.low[axis];
  if (size[2] <= size[0] && size[2] <= size[1]) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (size[0] <= size[1]) return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
}

}  // namespace

Projection::Projection(const View& view, const Spheres& shown, PanelSize panel, double margin)
    : view_(view), panel_(panel) {
  const Range right = RangeAlong(view.right, shown), up = RangeAlong(view.up, shown);
  scale_ = std::min((panel.width - 2 * margin) / (right.high - right.low),
                    (panel.height - 2 * margin) / (up.high - up.low));
  middle_right_ = right.middle();
  middle_up_ = up.middle();
}

PanelPoint Projection::Project(const WorldPoint& p) const {
  return {panel_.width / 2 + scale_ * (Dot(p, view_.right) - middle_right_),
          panel_.height / 2 - scale_ * (Dot(p, view_.up) - middle_up_),
          scale_ * Dot(p, view_.toward)};
}

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

Front FrontOf(const WorldBox& box, const std::optional<SliceFacts>& slice) {
  // Points of one slice lie on both of its faces; the box is half a step larger, and another half
  // is left for rounding. Boxes that look as flat count, too.
  constexpr double kMoreSteps = 1.5, kFlat = 0.02;
  const double x = box.high[0] - box.low[0], y = box.high[1] - box.low[1];
  const double z = box.high[2] - box.low[2];
  const bool flat =
      slice.has_value() && z <= std::min(x, y) &&
      z <= std::max((slice->slabs + kMoreSteps) * slice->step, kFlat * std::min(x, y));
  if (!flat) return {BroadsideOf(box), kTurn, kClimb};
  const bool anterior = slice->axes.size() == 3 && slice->axes[1] == 'A';
  if (anterior) return {BroadsideOf(box), 0, 0};
  return {{{1, 0, 0}, {0, -1, 0}, {0, 0, -1}}, 0, 0};
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

}  // namespace bccskel::exporting
