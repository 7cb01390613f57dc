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

}  // namespace bccskel::exporting
