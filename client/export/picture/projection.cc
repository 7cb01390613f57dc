#include "client/export/picture/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace bccskel::exporting {
namespace {

WorldPoint Combine(double s, const WorldPoint& a, double t, const WorldPoint& b) {
  return {s * a[0] + t * b[0], s * a[1] + t * b[1], s * a[2] + t * b[2]};
}

// Smallest and largest place along a unit vector.
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

View ViewFrom(const WorldBox& box, double turn, double climb) {
  constexpr double kRadians = std::numbers::pi / 180;
  const double cos_turn = std::cos(turn * kRadians), sin_turn = std::sin(turn * kRadians);
  const double cos_climb = std::cos(climb * kRadians), sin_climb = std::sin(climb * kRadians);
  const View front = BroadsideOf(box);
  const WorldPoint level = Combine(cos_turn, front.toward, sin_turn, front.right);
  return {Combine(cos_turn, front.right, -sin_turn, front.toward),
          Combine(cos_climb, front.up, -sin_climb, level),
          Combine(cos_climb, level, sin_climb, front.up)};
}

std::array<View, 3> ViewsOf(const WorldBox& box) {
  return {ViewFrom(box, 30, 15), ViewFrom(box, 90, 0), ViewFrom(box, 0, 90)};
}

}  // namespace bccskel::exporting
