#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/lattice/lattice_point.h"

namespace bccskel::exporting {

// Where a viewer stands: three orthonormal world vectors.
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

// Spheres of one radius in the world: what a picture must contain.
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

// Parallel projection that fills a panel with what it shows.
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

// The smallest box around some points; at the origin around none.
WorldBox BoxOf(std::span<const WorldPoint> points);

// What an object of an image says about its first view.
struct SliceFacts {
  double step;            // between lattice points along z, in world units
  int slabs;              // steps in a slice
  std::string_view axes;  // what those of the world point to: "RAS", ...; may be unknown
};

// Where pictures begin.
struct Front {
  View view;
  double turn;   // degrees, as those of ViewFrom(), by which the first picture is off
  double climb;  // the front
};

// A three-quarter view on the broadest side of the box; up is +y, or +z when y is the thinnest
// axis. An object of an image (`slice` is known) that is as thin as one slice along z is looked at
// as programs show images: straight, x to the right, and y down unless it points to the anterior.
// Needs: a box no more than half a step larger than the points.
Front FrontOf(const WorldBox& box, const std::optional<SliceFacts>& slice);

// The front after a walk of `turn` degrees around the object to the right and a climb of `climb`
// degrees.
View ViewFrom(const View& front, double turn, double climb);

// The first view, then another one from the side, then one from above or, of a front that is
// straight, three quarters.
std::array<View, 3> ViewsOf(const Front& front);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
