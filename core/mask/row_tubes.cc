#include "core/mask/row_tubes.h"

#include <algorithm>
#include <limits>

namespace bccskel {

int32_t RowTubes::NextTube(int32_t by) {
  int32_t next = -1;
  for (size_t s = 0; s < slices_.size(); ++s) {
    size_t& at = cursors_[s];
    while (at < slices_[s].size() && slices_[s].y(at) < kBrickY * by - 1) ++at;
    // The last slice only affects corners that touch voxels of other slices.
    if (at == slices_[s].size() || s + 1 == slices_.size()) continue;
    const int32_t tube = std::max(by, slices_[s].y(at) / kBrickY);
    next = next < 0 ? tube : std::min(next, tube);
  }
  return next;
}

const RowTube& RowTubes::Fill(int32_t by) {
  std::array<MaskRow, RowTube::kSlices * RowTube::kRows> rows;
  int32_t begin = std::numeric_limits<int32_t>::max(), end = 0;
  for (size_t s = 0; s < slices_.size(); ++s) {
    for (size_t at = cursors_[s]; at < slices_[s].size(); ++at) {
      const MaskRow row = slices_[s][at];
      const int32_t r = row.y - (kBrickY * by - 1);
      if (r >= RowTube::kRows) break;
      if (r < 0) continue;
      rows[s * RowTube::kRows + static_cast<size_t>(r)] = row;
      begin = std::min(begin, row.first_word);
      end = std::max(end, row.end_word());
    }
  }
  const size_t stride = static_cast<size_t>(end - begin) + 3;
  words_.assign(rows.size() * stride, 0);
  for (size_t n = 0; n < rows.size(); ++n) {
    if (rows[n].words.empty()) continue;
    std::ranges::copy(rows[n].words, words_.begin() + static_cast<ptrdiff_t>(n * stride + 1) +
                                         (rows[n].first_word - begin));
  }
  tube_ = {by, bz_, begin, end - begin, words_.data() + 1, stride};
  return tube_;
}

void RowTubes::NextLayer(int32_t limit) {
  std::swap(slices_[0], slices_[RowTube::kSlices - 2]);
  std::swap(slices_[1], slices_[RowTube::kSlices - 1]);
  for (size_t s = 2; s < slices_.size(); ++s) slices_[s].Clear();
  bz_ = slices_[0].empty() && slices_[1].empty() ? limit : bz_ + 1;
}

}  // namespace bccskel
