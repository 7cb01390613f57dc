#ifndef BCCSKEL_CORE_VOXELIZE_VOXELIZE_H_
#define BCCSKEL_CORE_VOXELIZE_VOXELIZE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/mesh/mesh_report.h"
#include "core/mesh/triangle_mesh.h"
#include "core/volume/volume.h"

namespace bccskel {

// Which points are inside.
//
// kAuto     closed and consistently oriented surfaces: kWinding. Closed ones with inconsistent
//           orientation: kParity, with a warning. Open ones are refused; the message says how many
//           boundary edges there are.
// kParity   inside where a ray crosses the surface an odd number of times. Needs a closed surface.
//           Where parts overlap there is a hole; a nested shell is a cavity whatever its
//           orientation; a part given twice vanishes.
// kWinding  inside where the winding number is not 0. Each outermost component and all that it
//           encloses are first turned so that the outermost one points outward, so inverted meshes
//           give the same bits. Overlapping parts are joined; a nested shell is a cavity when it
//           is oriented against the shell around it, and changes nothing when it is oriented alike.
//           Closed surfaces of inconsistent orientation are refused. Open ones, and those with odd
//           edges, are filled where the generalized winding number (Jacobson, Kavan,
//           Sorkine-Hornung 2013) exceeds 1/2, after turning the mesh so that its volume is
//           positive, with a warning.
enum class FillRule { kAuto, kParity, kWinding };

struct VoxelizeOptions {
  // Exactly one of these two. The number of points is met within 2 % where the solid has enough of
  // them; the spacing is the edge of the cubic cell in the mesh's unit of length.
  std::optional<uint64_t> points;
  std::optional<double> spacing;
  FillRule fill = FillRule::kAuto;
  uint64_t max_points = uint64_t{1} << 33;
};

struct VoxelizeResult {
  Volume volume;
  MeshReport mesh;
  std::vector<std::string> warnings;  // sentences for a person
  FillRule fill = FillRule::kParity;  // the rule used, never kAuto
};

// Lays a bcc grid over the mesh, its middle on the middle of the box, and takes the lattice points
// inside. Points exactly on the surface are inside where (x + e^3, y + e, z + e^2) is, for a
// vanishing e > 0 (see core/mesh/ray_crossing.h), so a box of whole cells gives half-open ranges.
// Does:    snaps vertices to 2^-16 lattice units, casts an exact ray along x through every lattice
//          row and fills spans into sparse bricks.
// Cost:    time and memory follow the surface in rows and the solid in bricks, not the box.
// Errors:  INVALID_ARGUMENT (options, nothing enclosed, sizes a double cannot hold, kParity for an
//          open mesh, kWinding for a closed one of inconsistent orientation), FAILED_PRECONDITION
//          (kAuto for an open mesh), RESOURCE_EXHAUSTED (more than kMaxExtentCells cells along an
//          axis, more points than max_points), CANCELLED, DEADLINE_EXCEEDED.
// Threads: same bits for any number of threads.
absl::StatusOr<VoxelizeResult> Voxelize(const TriangleMesh& mesh, const VoxelizeOptions& options,
                                        const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOXELIZE_VOXELIZE_H_
