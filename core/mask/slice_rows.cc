#include "core/mask/slice_rows.h"

#include <algorithm>

namespace bccskel {
namespace {

// Bits [begin, end) of a word, 0 <= begin < end <= 64.
uint64_t BitsOf(int32_t begin, int32_t end) {
  return ~uint64_t{0} >> (64 - (end - begin)) << begin;
}

// Each bit of the low half twice.
uint64_t Doubled(uint64_t bits) {
  bits &= 0xffffffff;
  bits = (bits | bits << 16) & 0x0000ffff0000ffff;
  bits = (bits | bits << 8) & 0x00ff00ff00ff00ff;
  bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0f;
  bits = (bits | bits << 2) & 0x3333333333333333;
  bits = (bits | bits << 1) & 0x5555555555555555;
  return bits | bits << 1;
}

}  // namespace

void SliceRows::Clear() {
  rows_.clear();
  words_.clear();
}

void SliceRows::SetDense(const MaskGrid& grid, std::span<const uint64_t> words) {
  Clear();
  const auto occupied = [](uint64_t word) { return word != 0; };
  for (int32_t y = 0; y < grid.ny; ++y) {
    const auto row = words.subspan(static_cast<size_t>(y) * grid.WordsPerRow(), grid.WordsPerRow());
    const auto first = std::find_if(row.begin(), row.end(), occupied);
    if (first == row.end()) continue;
    const auto end = std::find_if(row.rbegin(), row.rend(), occupied).base();
    rows_.push_back({y, static_cast<int32_t>(first - row.begin()), words_.size(),
                     static_cast<size_t>(end - first)});
    words_.insert(words_.end(), first, end);
  }
}

void SliceRows::AddRun(int32_t y, int32_t begin, int32_t end) {
  const int32_t first_word = begin / 64, end_word = (end + 63) / 64;
  if (rows_.empty() || rows_.back().y != y) rows_.push_back({y, first_word, words_.size(), 0});
  Row& row = rows_.back();
  row.count = static_cast<size_t>(end_word - row.first_word);
  words_.resize(row.offset + row.count);
  for (int32_t word = first_word; word < end_word; ++word) {
    words_[row.offset + static_cast<size_t>(word - row.first_word)] |=
        BitsOf(std::max(begin - 64 * word, 0), std::min(end - 64 * word, 64));
  }
}

void SliceRows::SetRefined(const SliceRows& voxels) {
  Clear();
  for (size_t n = 0; n < voxels.size(); ++n) {
    const MaskRow row = voxels[n];
    // Half a word of voxels makes a word.
    const size_t first = static_cast<uint32_t>(row.words.front()) == 0 ? 1 : 0;
    const size_t end = 2 * row.words.size() - (row.words.back() >> 32 == 0 ? 1 : 0);
    const int32_t first_word = 2 * row.first_word + static_cast<int32_t>(first);
    for (int32_t y : {2 * row.y, 2 * row.y + 1}) {
      rows_.push_back({y, first_word, words_.size(), end - first});
    }
    for (size_t half = first; half < end; ++half) {
      words_.push_back(Doubled(row.words[half / 2] >> 32 * (half % 2)));
    }
  }
}

MaskRow SliceRows::Find(int32_t y) const {
  const auto row = std::ranges::lower_bound(rows_, y, {}, &Row::y);
  if (row == rows_.end() || row->y != y) return {};
  return (*this)[static_cast<size_t>(row - rows_.begin())];
}

}  // namespace bccskel
