#include "client/export/picture/projection.h"

#include <algorithm>
#include <limits>

namespace bccskel::exporting {
namespace {

// The extent along a unit vector.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  double middle() const { return low / 2 + high / 2; }
  double length() const { return high > low ? high - low : kLeast; }

  static constexpr double kLeast = 1e-9;  // so that a point has a scale
};

Range RangeAlong(const WorldPoint& v, std::span<const WorldPoint> shown) {
  if (shown.empty()) return {0, 0};
  Range range;
  for (const WorldPoint& point : shown) {
    const double place = Dot(v, point);
    range.low = std::min(range.low, place);
    range.high = std::max(range.high, place);
  }
  return range;
}

}  // namespace

Projection::Projection(const View& view, std::span<const WorldPoint> shown, PanelSize panel,
                       double margin)
    : view_(view), panel_(panel) {
  const Range right = RangeAlong(view.right, shown), up = RangeAlong(view.up, shown);
  scale_ = std::min((panel.width - 2 * margin) / right.length(),
                    (panel.height - 2 * margin) / up.length());
  middle_right_ = right.middle();
  middle_up_ = up.middle();
}

PanelPoint Projection::Project(const WorldPoint& p) const {
  return {panel_.width / 2 + scale_ * (Dot(p, view_.right) - middle_right_),
          panel_.height / 2 - scale_ * (Dot(p, view_.up) - middle_up_),
          scale_ * Dot(p, view_.toward)};
}

}  // namespace bccskel::exporting
