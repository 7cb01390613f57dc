#ifndef BCCSKEL_CORE_EXPORT_SURFACE_CELL_GRID_H_
#define BCCSKEL_CORE_EXPORT_SURFACE_CELL_GRID_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "absl/status/statusor.h"
#include "core/exec/context.h"
#include "core/export/surface/surface_mesh.h"
#include "core/volume/volume.h"

namespace bccskel {

// The place of a cell in its brick, in bit order.
constexpr size_t CellAt(int x, int y, int z) {
  return static_cast<size_t>(x + kBrickX * (y + kBrickY * z));
}

// An object as cubes, for surfaces of objects too large to be shown point by point. A cube stands
// for an odd point of the lattice, or for 8, 64, ... of them. The exact conversion of an image has
// two odd points along each edge of a voxel, so cubes of 4 lattice units are its voxels again.
class CellGrid {
 public:
  // How full the cells of a brick are, 0 to 255, in bit order; 0 only where no point is set.
  using Fills = std::array<uint8_t, kBrickPoints>;

  // Cells of 2 lattice units. An even point without an odd neighbor takes the cell above it.
  // Errors: those of the context.
  static absl::StatusOr<CellGrid> Of(const Volume& object, const exec::Context& context);

  // Cells twice as wide. Errors: those of the context.
  absl::StatusOr<CellGrid> Halved(const exec::Context& context) const;

  float edge() const { return edge_; }  // lattice units
  // About: counted inside of bricks, and the share between bricks added.
  double TriangleEstimate() const;

  const std::vector<BrickKey>& keys() const { return keys_; }  // strictly increasing, odd
  const Fills& fills(size_t brick) const { return fills_[brick]; }
  std::optional<size_t> Find(int32_t bx, int32_t by, int32_t bz) const;

 private:
  Fills HalvedFills(const BrickCoordinates& half) const;

  float edge_ = 2;
  std::vector<BrickKey> keys_;
  std::vector<Fills> fills_;
};

// The surface between the cells with points and those without, in lattice units: a vertex wherever
// the two meet around a corner of cells, nearer to the emptier cells the fuller the others are. Two
// triangles for each face between two cells, so a tenth of ExtractSurface() for the finest cells
// and a fourth of that for each halving. Always closed and oriented; parts may touch along edges
// where cells do. Gaps narrower than a cell are closed, nothing thin is lost. Errors: CANCELLED,
// DEADLINE_EXCEEDED.
absl::StatusOr<SurfaceMesh> ExtractCellSurface(const CellGrid& grid, const exec::Context& context);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_EXPORT_SURFACE_CELL_GRID_H_
