#ifndef BCCSKEL_CORE_MASK_SLICE_ROWS_H_
#define BCCSKEL_CORE_MASK_SLICE_ROWS_H_

#include <bit>
#include <cstdint>
#include <span>
#include <vector>

#include "core/mask/mask_grid.h"

namespace bccskel {

// The occupied part of one row of a mask: bit b of words[n] is voxel 64 * (first_word + n) + b.
// The first and the last word are not zero.
struct MaskRow {
  int32_t y = 0;
  int32_t first_word = 0;
  std::span<const uint64_t> words;

  int32_t end_word() const { return first_word + static_cast<int32_t>(words.size()); }
};

// Calls visit(begin, end) for each maximal run of voxels [begin, end) of the row, in order.
template <typename Visit>
void ForEachRun(const MaskRow& row, Visit visit) {
  int32_t x = 64 * row.first_word, begin = 0;
  uint64_t before = 0;  // the voxel to the left, as the lowest bit
  for (uint64_t word : row.words) {
    for (uint64_t edges = word ^ (word << 1 | before); edges != 0; edges &= edges - 1) {
      const int bit = std::countr_zero(edges);
      if ((word >> bit & 1) != 0) {
        begin = x + bit;
      } else {
        visit(begin, x + bit);
      }
    }
    before = word >> 63;
    x += 64;
  }
  if (before != 0) visit(begin, x);
}

// The occupied rows of one slice, by y.
class SliceRows {
 public:
  void Clear();
  // Replaces the rows by those of a dense slice. Shapes: grid.WordsPerSlice() words.
  void SetDense(const MaskGrid& grid, std::span<const uint64_t> words);
  // Adds the voxels [begin, end). Needs: called in order of y, then x; runs do not overlap.
  void AddRun(int32_t y, int32_t begin, int32_t end);
  // Replaces the rows by those of `voxels` cut into px by py parts.
  void SetParts(const SliceRows& voxels, int32_t px, int32_t py);

  bool empty() const { return rows_.empty(); }
  size_t size() const { return rows_.size(); }
  int32_t y(size_t n) const { return rows_[n].y; }
  MaskRow operator[](size_t n) const {
    const Row& row = rows_[n];
    return {row.y, row.first_word, std::span(words_).subspan(row.offset, row.count)};
  }
  // Row y; no words if it is not occupied.
  MaskRow Find(int32_t y) const;

 private:
  struct Row {
    int32_t y;
    int32_t first_word;
    size_t offset;
    size_t count;
  };
  std::vector<Row> rows_;
  std::vector<uint64_t> words_;
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_MASK_SLICE_ROWS_H_
