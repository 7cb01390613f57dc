#ifndef BCCSKEL_CORE_MASK_ROW_TUBES_H_
#define BCCSKEL_CORE_MASK_ROW_TUBES_H_

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "core/mask/slice_rows.h"
#include "core/volume/brick.h"

namespace bccskel {

// All voxels that determine one line of bricks along x. Line (by, bz) holds rows 4 by to 4 by + 3
// of slices 8 bz to 8 bz + 7. Corners lie before their voxels, so they touch the previous row and
// slice; whether one stays also depends on the next row and slice.
struct RowTube {
  static constexpr int kSlices = kBrickZ + 2;
  static constexpr int kRows = kBrickY + 2;

  int32_t by = 0;
  int32_t bz = 0;
  int32_t first_word = 0;  // the same for all rows
  int32_t word_count = 0;
  const uint64_t* words = nullptr;  // of row (0, 0)
  size_t stride = 0;

  // Row 4 by - 1 + row of slice 8 bz - 1 + slice. Word n is word first_word + n of the mask,
  // -1 <= n <= word_count + 1; the first and the last two of these are zero.
  const uint64_t* Row(int slice, int row) const {
    return words + static_cast<size_t>(slice * kRows + row) * stride;
  }
};

// Cuts a mask, slice by slice, into its occupied tubes.
// Memory: the occupied rows of ten slices. Cost: each row is copied into at most four tubes.
class RowTubes {
 public:
  // Moves the rows of slice z out of `rows` and calls visit(const RowTube&) for the tubes that are
  // complete, in order of (bz, by).
  // Needs: z increases from call to call; omitted slices are empty.
  template <typename Visit>
  void AddSlice(int32_t z, SliceRows& rows, Visit visit) {
    while (z > FirstSlice() + RowTube::kSlices - 1) VisitLayer(z / kBrickZ, visit);
    std::swap(slices_[static_cast<size_t>(z - FirstSlice())], rows);
  }

  template <typename Visit>
  void Finish(Visit visit) {
    VisitLayer(bz_ + 1, visit);
    VisitLayer(bz_ + 1, visit);
  }

 private:
  int32_t FirstSlice() const { return kBrickZ * bz_ - 1; }

  // Continues with the next layer of bricks that may be occupied, at most `limit`.
  template <typename Visit>
  void VisitLayer(int32_t limit, Visit visit) {
    cursors_ = {};
    for (int32_t by = NextTube(0); by >= 0; by = NextTube(by + 1)) visit(Fill(by));
    NextLayer(limit);
  }

  // The first line of bricks from `by` on whose corners or centers may be occupied, or -1.
  int32_t NextTube(int32_t by);
  const RowTube& Fill(int32_t by);
  void NextLayer(int32_t limit);

  std::array<SliceRows, RowTube::kSlices> slices_;  // from FirstSlice() on
  std::array<size_t, RowTube::kSlices> cursors_ = {};
  int32_t bz_ = 0;
  RowTube tube_;
  std::vector<uint64_t> words_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_ROW_TUBES_H_
