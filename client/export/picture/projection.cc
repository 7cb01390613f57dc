#include "client/export/picture/projection.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace bccskel::exporting {
namespace {

double Dot(const WorldPoint& a, const WorldPoint& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

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

// Looks straight at the box's broadest side. Up is +y, or +z when y is the thinnest axis.
View BroadsideOf(const WorldBox& box) {
  std::array<double, 3> size;
  for (size_t axis = 0; axis < 3; ++axis) size[axis] = box.high[axis] - box.low[axis];
  if (size[2] <= size[0] && size[2] <= size[1]) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  if (size[0] <= size[1]) return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  return {{1, 0, 0}, {0, 0, 1}, {0, -1, 0}};
}

// Walks around the object to the right by a quarter of a right angle or so, then climbs a little.
View ThreeQuarter(const View& view) {
  constexpr double kCosTurn = 0.8660254037844386, kSinTurn = 0.5;                   // 30 degrees
  constexpr double kCosClimb = 0.9659258262890683, kSinClimb = 0.2588190451025208;  // 15 degrees
  const WorldPoint level = Combine(kCosTurn, view.toward, kSinTurn, view.right);
  return {Combine(kCosTurn, view.right, -kSinTurn, view.toward),
          Combine(kCosClimb, view.up, -kSinClimb, level),
          Combine(kCosClimb, level, kSinClimb, view.up)};
}

WorldPoint Negated(const WorldPoint& v) { return {-v[0], -v[1], -v[2]}; }

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

std::array<View, 3> ViewsOf(const WorldBox& box) {
  const View front = BroadsideOf(box);
  const View side = {Negated(front.toward), front.up, front.right};
  const View above = {front.right, Negated(front.toward), front.up};
  return {ThreeQuarter(front), side, above};
}

}  // namespace bccskel::exporting
