#ifndef BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
#define BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_

#include <array>
#include <span>
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

// The broadest side of the box, after a walk of `turn` degrees around it to the right and a climb
// of `climb` degrees. Up is +y, or +z when y is the thinnest axis.
View ViewFrom(const WorldBox& box, double turn, double climb);

// A three-quarter view on the broadest side of the box, then from its side, then from above.
std::array<View, 3> ViewsOf(const WorldBox& box);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
