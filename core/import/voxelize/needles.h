#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_NEEDLES_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_NEEDLES_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/voxelize/surface_sides.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel {

// The lattice points that keep needles whole: hairs, feelers, wires, the last part of a point. Rows
// of the lattice pass beside them.
// Does:    casts rays inward from every triangle that is less than two units wide, half a unit
//          apart, where the solid may be thin. Where a ray leaves it
//          within two units through a side that faces away, the point nearest to the ray's middle
//          counts.
// Why it is right: lattice points whose cells a connected curve visits are connected, since the 14
//          neighbors of a point are those whose Voronoi cells share a face with its cell, and cells
//          that meet in an edge or a corner share faces, too.
// Needs:   `sampling` was filled from the surface; `thin` are the triangles behind which it may be
//          thin.
// Returns: points in no order, some more than once; some may lie outside the lattice's extent.
//          Incomplete if the context requests a stop.
// Cost:    about 1 us per ray.
// Errors:  RESOURCE_EXHAUSTED if the edges of the triangles are so long that no real mesh needs it.
absl::StatusOr<std::vector<LatticePoint>> NeedlePoints(const SurfaceSides& sides,
                                                       std::span<const uint32_t> thin,
                                                       const Volume& sampling,
                                                       const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_NEEDLES_H_
