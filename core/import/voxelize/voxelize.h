#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_VOXELIZE_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_VOXELIZE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "absl/status/statusor.h"
#include "core/certificate/certificate.h"
#include "core/exec/context.h"
#include "core/import/mesh/mesh_report.h"
#include "core/import/mesh/triangle_mesh.h"
#include "core/import/voxelize/fill_rule.h"
#include "core/import/voxelize/grid_fit.h"
#include "core/import/voxelize/thin_parts.h"
#include "core/volume/volume.h"

namespace bccskel {

// Whether the topology of the grid is counted and compared with that of a closed mesh, which is
// that of the solid if the mesh does not cross itself. Where the grid has more of something, the
// volume is repaired as far as that succeeds (see topology_repair.h).
enum class TopologyCheck { kCompare, kSkip };

// A spacing larger than the mesh is a mistake, unless it is that of a result of few points.
enum class LargeCells { kRefuse, kAccept };

// The axes of the lattice: the mesh's own (ShapeAxesOf()), so that the result does not depend on
// its pose, or the world's. Of the mesh's own, the first that give its topology, where it is
// compared.
enum class LatticeAxes { kShape, kWorld };

struct VoxelizeOptions {
  // Exactly one of these two. The number of points is met within 2 % where the solid has enough of
  // them, not counting those that keep thin parts; the spacing is the edge of the cubic cell in the
  // mesh's unit of length.
  std::optional<uint64_t> points = {};
  std::optional<double> spacing = {};
  // Of a spacing. A number of points takes a centered grid, unless only one off the center has it.
  GridShift shift = GridShift::kCentered;
  LatticeAxes axes = LatticeAxes::kShape;
  LargeCells large_cells = LargeCells::kRefuse;
  FillRule fill = FillRule::kAuto;
  // Not with kParity, which does not say on which side of the surface the solid is.
  ThinParts thin_parts = ThinParts::kKeep;
  TopologyCheck topology = TopologyCheck::kCompare;
  uint64_t max_points = uint64_t{1} << 33;
};

struct VoxelizeResult {
  Volume volume;
  MeshReport mesh;
  uint64_t added_points = 0;             // to keep thin parts
  std::vector<std::string> warnings;     // sentences for a person
  FillRule fill = FillRule::kParity;     // the rule used, never kAuto
  std::optional<BettiNumbers> topology;  // of the volume, with TopologyCheck::kCompare
};

// Lays a bcc grid over the mesh, its middle on or near the middle of the mesh's box along the
// grid's axes, and takes the lattice points inside. Points exactly on the surface are inside where
// (x + e^3, y + e, z + e^2) is, for a vanishing e > 0 (see core/import/mesh/ray_crossing.h), so a
// box of whole cells gives half-open ranges.
// Does:    snaps vertices to 2^-16 lattice units, casts an exact ray along x through every lattice
//          row and fills spans into sparse bricks.
// Cost:    time and memory follow the surface in rows and the solid in bricks, not the box.
// Errors:  INVALID_ARGUMENT (options, nothing enclosed, cells that LargeCells refuses, sizes a
//          double cannot hold, kParity for an open mesh, kWinding for a closed one of inconsistent
//          orientation), FAILED_PRECONDITION (kAuto for an open mesh with defects above FillRule's
//          limits), RESOURCE_EXHAUSTED (more than kMaxExtentCells cells along an axis, more points
//          than max_points), CANCELLED, DEADLINE_EXCEEDED.
// Threads: same bits for any number of threads.
absl::StatusOr<VoxelizeResult> Voxelize(const TriangleMesh& mesh, const VoxelizeOptions& options,
                                        const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_VOXELIZE_H_
