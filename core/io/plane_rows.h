#ifndef BCCSKEL_CORE_IO_PLANE_ROWS_H_
#define BCCSKEL_CORE_IO_PLANE_ROWS_H_

#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace bccskel {

// The dense encodings and the bricks meet in rows: the words of one channel (32 layers) for the
// four rows of cells that a brick row covers.
struct PlaneRowsPlace {
  Sublattice sublattice = Sublattice::kEven;
  int32_t by = 0;       // rows 4 * by .. 4 * by + 3
  int32_t channel = 0;  // layers 32 * channel .. 32 * channel + 31
};

// Row j of the block begins at words[j * stride] and has nx words; rows past the extent are not
// there. Word is uint32_t or const uint32_t.
template <typename Word>
struct PlaneRows {
  Word* words = nullptr;
  size_t stride = 0;
  size_t rows = 0;  // 1..4
};

// Rows of cells that brick row `by` has inside the extent.
constexpr size_t RowsInBrickRow(const LatticeExtent& extent, int32_t by) {
  const int32_t left = extent.ny - 4 * by;
  return static_cast<size_t>(left < 4 ? left : 4);
}

constexpr int32_t BrickRowCount(const LatticeExtent& extent) { return (extent.ny + 3) / 4; }

}  // namespace bccskel

#endif  // BCCSKEL_CORE_IO_PLANE_ROWS_H_
