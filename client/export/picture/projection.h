#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_

#include <span>

#include "client/view/first_view.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

using view::View;

// Spheres of equal radius in the world that a picture must contain.
struct Spheres {
  std::span<const WorldPoint> centers;
  double radius;
};

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

// Parallel projection that fits the shown spheres to a panel.
class Projection {
 public:
  // Needs: at least one center, a radius > 0, the panel larger than twice the margin.
  Projection(const View& view, const Spheres& shown, PanelSize panel, double margin);

  PanelPoint Project(const WorldPoint& p) const;
  double scale() const { return scale_; }  // panel units per world unit
  const View& view() const { return view_; }

 private:
  View view_;
  PanelSize panel_;
  double scale_;
  double middle_right_;  // along the view's axes, world units
  double middle_up_;
};

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
