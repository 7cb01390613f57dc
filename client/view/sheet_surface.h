#ifndef BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_
#define BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_

#include <cstdint>
#include <vector>

#include "client/view/result_document.h"
#include "core/export/surface/surface_mesh.h"

namespace bccskel::view {

// The sheets of a skeleton for display: triangles between neighbors on the lattice, with its steps
// smoothed. They have no inside and no outside.
struct SheetSurface {
  std::vector<WorldPoint> vertices;
  std::vector<double> radii;     // one per vertex, world units
  std::vector<uint32_t> labels;  // one per vertex, index into the result's labels; empty if none
  std::vector<SurfaceTriangle> triangles;
};

// Thick spots of curves are too small to be seen as sheets and are omitted. Empty for results
// without a placement.
// Cost: follows the points of the skeleton if there are any sheets.
SheetSurface SheetSurfaceOf(const ResultDocument& result);

}  // namespace bccskel::view

#endif  // BCCSKEL_CLIENT_VIEW_SHEET_SURFACE_H_
