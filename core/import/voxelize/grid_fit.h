#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_GRID_FIT_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_GRID_FIT_H_

#include <vector>

#include "absl/status/statusor.h"
#include "core/import/mesh/mesh_report.h"
#include "core/import/mesh/ray_crossing.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {

// The lattice unit (half a cell) is cut into this many ticks; vertices are snapped to ticks. 2^23
// lattice units along an axis times 2^16 ticks stay within the 40 bits of exact ray crossing.
inline constexpr int kTickBits = 16;

// Where the middle of the mesh lies: on the middle of the lattice, or some thirds of a
// lattice unit beside it, still within the margin.
enum class GridShift { kCentered, kOffCenter };

// A bcc grid laid over the unit cube of a Surface: the middle of the box is the middle of the
// lattice, at lattice coordinate n - 1/2 along each axis, with at least half a lattice unit of
// margin. So a mesh and its reflection in a point get reflected points.
struct GridFit {
  LatticeExtent extent;
  Placement placement;
  std::array<double, 3> offset = {};  // lattice coordinate = offset + unit coordinate * scale
  double scale = 0;

  GridPoint Snap(const TriangleMesh::Vertex& unit) const;
};

// Units:  `unit_spacing` is the edge of the cubic cell in units of the surface.
// Errors: INVALID_ARGUMENT when origin or spacing do not fit a double; RESOURCE_EXHAUSTED when an
//         axis needs more than kMaxExtentCells cells.
absl::StatusOr<GridFit> FitGrid(const Surface& surface, double unit_spacing, GridShift shift);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_GRID_FIT_H_
