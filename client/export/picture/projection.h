#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

// The direction of a view: three orthonormal world vectors.
struct View {
  WorldPoint right;
  WorldPoint up;
  WorldPoint toward;  // from the object to the viewer
};

// Axis-parallel box in the world.
struct WorldBox {
  WorldPoint low;
  WorldPoint high;
};

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

// The bounding box of the points; a box at the origin if there are none.
WorldBox BoxOf(std::span<const WorldPoint> points);

// Facts about an image that determine the first view of its object.
struct SliceFacts {
  double step;            // between lattice points along z, in world units
  int slabs;              // steps in a slice
  std::string_view axes;  // where the world's axes point: "RAS", ...; may be unknown
};

// The first view of an object.
struct Front {
  View view;
  double turn;   // degrees, as in ViewFrom(), from the front to the first picture
  double climb;  // the front
};

// A three-quarter view of the broadest side of the box; up is +y, or +z when y is the thinnest
// axis. A flat object that would show its edge is seen from where it covers most. An object of an
// image (`slice` is known) that is one slice thick along z is seen as programs show images:
// straight, x to the right, and y down unless it points to the anterior.
// Needs: a box no more than half a step larger than the points.
Front FrontOf(const WorldBox& box, std::span<const WorldPoint> points,
              const std::optional<SliceFacts>& slice);

// The view after moving `turn` degrees to the right around the object and `climb` degrees up.
View ViewFrom(const View& front, double turn, double climb);

// The first view, one from the side, and one from above or, for a straight front, a three-quarter
// view.
std::array<View, 3> ViewsOf(const Front& front);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
