#include "core/mask/slice_rows.h"

#include <algorithm>

namespace bccskel {
namespace {

// Bits [begin, end) of a word, 0 <= begin < end <= 64.
uint64_t BitsOf(int32_t begin, int32_t end) {
  return ~uint64_t{0} >> (64 - (end - begin)) << begin;
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

void SliceRows::SetParts(const SliceRows& voxels, int32_t px, int32_t py) {
  Clear();
  for (size_t n = 0; n < voxels.size(); ++n) {
    const MaskRow row = voxels[n];
    for (int32_t y = py * row.y; y < py * (row.y + 1); ++y) {
      if (px == 1) {
        rows_.push_back({y, row.first_word, words_.size(), row.words.size()});
        words_.insert(words_.end(), row.words.begin(), row.words.end());
      } else {
        ForEachRun(row, [&](int32_t begin, int32_t end) { AddRun(y, px * begin, px * end); });
      }
    }
  }
}

MaskRow SliceRows::Find(int32_t y) const {
  const auto row = std::ranges::lower_bound(rows_, y, {}, &Row::y);
  if (row == rows_.end() || row->y != y) return {};
  return (*this)[static_cast<size_t>(row - rows_.begin())];
}

}  // namespace bccskel
