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

// Parallel projection of a world box that fills a panel.
class Projection {
 public:
  // Needs: a box with low <= high; the panel larger than twice the margin.
  Projection(const View& view, const WorldBox& box, PanelSize panel, double margin);

  PanelPoint Project(const WorldPoint& p) const;
  double scale() const { return scale_; }  // panel units per world unit
  const View& view() const { return view_; }

 private:
  View view_;
  WorldPoint center_;
  PanelSize panel_;
  double scale_;
};

// A three-quarter view on the broadest side of the box, then from its side, then from above.
std::array<View, 3> ViewsOf(const WorldBox& box);

}  // namespace bccskel::exporting

#endif  // BCCSKEL_CLIENT_EXPORT_PICTURE_PROJECTION_H_
