#ifndef BCCSKEL_CLIENT_VIEW_FIRST_VIEW_H_
#define BCCSKEL_CLIENT_VIEW_FIRST_VIEW_H_

#include <array>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "client/view/result_document.h"
#include "core/lattice/lattice_point.h"

namespace bccskel::view {

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

// The points that a picture must show: the object's surface or, without an object, the nodes,
// curves and sheets of its result.
std::vector<WorldPoint> ShownPoints(const ResultDocument& result,
                                    std::span<const WorldPoint> surface);

// The same of a result's object. `surface`: points of it; empty for the result alone.
Front FrontOf(const ResultDocument& result, std::span<const WorldPoint> surface);

// The view after moving `turn` degrees to the right around the object and `climb` degrees up.
View ViewFrom(const View& front, double turn, double climb);

// The first view, one from the side, and one from above or, for a straight front, a three-quarter
// view.
std::array<View, 3> ViewsOf(const Front& front);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_FIRST_VIEW_H_
