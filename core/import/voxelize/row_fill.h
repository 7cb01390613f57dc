#ifndef BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_FILL_H_
#define BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_FILL_H_

#include <cstdint>
#include <span>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/import/mesh/ray_crossing.h"
#include "core/import/mesh/triangle_mesh.h"
#include "core/lattice/lattice_point.h"
#include "core/volume/volume.h"

namespace bccskel {

// The lattice points with one y and one z: the cells i of row (j, k) of a sublattice.
struct LatticeRow {
  Sublattice sublattice = Sublattice::kEven;
  int32_t j = 0;
  int32_t k = 0;
};

// Half-open range of cells of a row.
struct CellSpan {
  int32_t begin = 0;
  int32_t end = 0;
};

// Decides which cells between two crossings of a row are inside.
class SegmentRule {
 public:
  virtual ~SegmentRule() = default;

  // `winding` and `crossings` are the sum of windings and the number of crossings before the
  // segment. Appends the inside parts of `segment`, in order.
  // Threads: called from all workers at once.
  virtual void Append(const LatticeRow& row, CellSpan segment, int winding, int crossings,
                      std::vector<CellSpan>& inside) const = 0;

  // Parts of rows to be asked about although the surface may not cross them.
  struct Region {
    CellSpan i, j, k;
  };
  virtual std::span<const Region> extra_regions() const { return {}; }
};

struct FillRequest {
  LatticeExtent extent;
  Placement placement;
  std::vector<GridPoint> vertices;  // in ticks, see grid_fit.h
  std::span<const TriangleMesh::Triangle> triangles;
  std::vector<int8_t> sign;  // +1 or -1 per triangle: its sense of winding
  uint64_t max_points = 0;
};

// Casts a ray along +x through every lattice row that the triangles meet and keeps what the rule
// calls inside.
// Cost:   one exact crossing per triangle and row, a sort of the crossings of each slab of bricks,
//         one 16-bit word per row and brick of the solid.
// Errors: RESOURCE_EXHAUSTED (too many crossings or points), CANCELLED, DEADLINE_EXCEEDED.
absl::StatusOr<Volume> FillRows(const FillRequest& request, const SegmentRule& rule,
                                const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IMPORT_VOXELIZE_ROW_FILL_H_
