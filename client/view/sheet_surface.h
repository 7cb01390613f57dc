#ifndef BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_
#define BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_

#include <vector>

#include "client/view/result_document.h"
#include "core/export/surface/surface_mesh.h"

namespace bccskel::view {

// The sheets of a skeleton for the eye: the triangles between neighbors on the lattice, with its
// steps smoothed away. They have no inside and no outside.
struct SheetSurface {
  std::vector<WorldPoint> vertices;
  std::vector<double> radii;  // one per vertex, world units
  std::vector<SurfaceTriangle> triangles;
};

// Thick spots of curves are too small to be seen as sheets and are left out. Empty for results
// that do not know where their lattice lies.
// Cost: follows the points of the skeleton where there are any of sheets.
SheetSurface SheetSurfaceOf(const ResultDocument& result);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_
