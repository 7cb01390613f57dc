#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_

#include <span>

#include "client/view/first_view.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

using view::View;

// A panel of a picture in its own units, x to the right and y down.
struct PanelSize {
  double width;
  double height;
};

// A world point on the panel; a larger depth is nearer to the viewer, in panel units.
struct PanelPoint {
  double x;
  double y;
  double depth;
};

// Parallel projection that fits the shown points to a panel.
class Projection {
 public:
  // No points: the world's origin lies in the middle.
  // Needs: the panel larger than twice the margin.
  Projection(const View& view, std::span<const WorldPoint> shown, PanelSize panel, double margin);

  PanelPoint Project(const WorldPoint& p) const;
  double scale() const { return scale_; }  // panel units per world unit

 private:
  View view_;
  PanelSize panel_;
  double scale_;
  double middle_right_;  // along the view's axes, world units
  double middle_up_;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
