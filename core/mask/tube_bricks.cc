#include "core/mask/tube_bricks.h"

#include <array>
#include <utility>

namespace bccskel {
namespace {

template <MaskAdjacency kAdjacency>
uint64_t Join(uint64_t a, uint64_t b) {
  return kAdjacency == MaskAdjacency::k26 ? a | b : a & b;
}

// 64 voxels of x at a time: for each of the eight layers and four rows of a line of even bricks the
// voxels that decide about its corners.
using CornerRows = std::array<std::array<uint64_t, kBrickY>, kBrickZ>;

// The words n of a tube's 15 rows.
struct TubeWords {
  std::array<std::array<uint64_t, RowTube::kRows>, RowTube::kSlices> at;
  uint64_t any = 0;
};

TubeWords WordsAt(const RowTube& tube, int32_t n) {
  TubeWords words;
  for (int s = 0; s < RowTube::kSlices; ++s) {
    for (int r = 0; r < RowTube::kRows; ++r) {
      const uint64_t word = tube.Row(s, r)[n];
      words.at[static_cast<size_t>(s)][static_cast<size_t>(r)] = word;
      words.any |= word;
    }
  }
  return words;
}

template <MaskAdjacency kAdjacency>
std::array<uint64_t, kBrickY> RowsOfLayer(const std::array<uint64_t, RowTube::kRows>& a,
                                          const std::array<uint64_t, RowTube::kRows>& b) {
  const auto join = [](uint64_t p, uint64_t q) { return Join<kAdjacency>(p, q); };
  const uint64_t r0 = join(a[0], b[0]), r1 = join(a[1], b[1]), r2 = join(a[2], b[2]);
  return {join(r0, r1), r1, join(r1, r2), r2};
}

// Even layers of corners lie between two slices, odd ones inside a slice; rows likewise.
template <MaskAdjacency kAdjacency>
CornerRows CornersOf(const TubeWords& words) {
  CornerRows rows;
  for (size_t s = 0; s + 1 < words.at.size(); ++s) {
    rows[2 * s] = RowsOfLayer<kAdjacency>(words.at[s], words.at[s + 1]);
    rows[2 * s + 1] = RowsOfLayer<kAdjacency>(words.at[s + 1], words.at[s + 1]);
  }
  return rows;
}

// Byte b of each of four words, in the low half of a 16-bit lane each.
uint64_t BytesAt(const std::array<uint64_t, kBrickY>& rows, int b) {
  const int shift = 8 * b;
  return (rows[0] >> shift & 0xff) | (rows[1] >> shift & 0xff) << 16 |
         (rows[2] >> shift & 0xff) << 32 | (rows[3] >> shift & 0xff) << 48;
}

// Doubles each bit of the low half of each 16-bit lane.
uint64_t Doubled(uint64_t lanes) {
  lanes = (lanes | lanes << 4) & 0x0f0f0f0f0f0f0f0f;
  lanes = (lanes | lanes << 2) & 0x3333333333333333;
  lanes = (lanes | lanes << 1) & 0x5555555555555555;
  return lanes | lanes << 1;
}

// Corner i of a row lies between the refined voxels i - 1 and i; the one before the lane's first
// comes as a bit.
template <MaskAdjacency kAdjacency>
uint64_t CornerLanes(uint64_t voxels, uint64_t first_bits) {
  constexpr uint64_t kFirst = 0x0001000100010001;
  const uint64_t here = Doubled(voxels);
  return Join<kAdjacency>(here, (here << 1 & ~kFirst) | (first_bits & kFirst));
}

// `before` is `rows` moved up by one voxel, so bit 8 b is the voxel to the left of byte b.
template <MaskAdjacency kAdjacency>
BrickBits EvenBrick(const CornerRows& rows, const CornerRows& before, int b) {
  BrickBits bits;
  for (size_t k = 0; k < kBrickZ; ++k) {
    bits.words[k] = CornerLanes<kAdjacency>(BytesAt(rows[k], b), BytesAt(before[k], b));
  }
  return bits;
}

BrickBits OddBrick(const TubeWords& words, int b) {
  BrickBits bits;
  for (size_t s = 1; s < words.at.size(); ++s) {
    const auto& [ignored, first, second] = words.at[s];
    const uint64_t layer = Doubled(BytesAt({first, first, second, second}, b));
    bits.words[2 * s - 2] = bits.words[2 * s - 1] = layer;
  }
  return bits;
}

CornerRows MovedUp(const CornerRows& rows, const CornerRows& word_before) {
  CornerRows moved;
  for (size_t k = 0; k < rows.size(); ++k) {
    for (size_t j = 0; j < rows[k].size(); ++j) {
      moved[k][j] = rows[k][j] << 1 | word_before[k][j] >> 63;
    }
  }
  return moved;
}

}  // namespace

void TubeBricks::Push(BrickCoordinates brick, const BrickBits& bits) {
  if (bits.Empty()) return;
  keys_.emplace_back(brick);
  bricks_.push_back(bits);
}

template <MaskAdjacency kAdjacency>
void TubeBricks::AddTube(const RowTube& tube) {
  CornerRows word_before = {};
  uint64_t any_before = 0;
  for (int32_t n = 0; n <= tube.word_count; ++n) {
    const TubeWords words = WordsAt(tube, n);
    const uint64_t reach = words.any | words.any << 1 | any_before >> 63;
    any_before = words.any;
    if (reach == 0) {
      word_before = {};
      continue;
    }
    const CornerRows rows = CornersOf<kAdjacency>(words);
    const CornerRows before = MovedUp(rows, word_before);
    for (int b = 0; b < 8; ++b) {
      if ((reach >> (8 * b) & 0xff) == 0) continue;
      const int32_t bx = 8 * (tube.first_word + n) + b;
      Push({bx, tube.by, tube.bz, Sublattice::kEven}, EvenBrick<kAdjacency>(rows, before, b));
      Push({bx, tube.by, tube.bz, Sublattice::kOdd}, OddBrick(words, b));
    }
    word_before = rows;
  }
}

void TubeBricks::Add(const RowTube& tube) {
  if (adjacency_ == MaskAdjacency::k26) {
    AddTube<MaskAdjacency::k26>(tube);
  } else {
    AddTube<MaskAdjacency::k6>(tube);
  }
}

Volume TubeBricks::Finish(LatticeExtent extent, const Placement& placement) && {
  return Volume::FromSortedBricks(extent, placement, std::move(keys_), std::move(bricks_));
}

}  // namespace bccskel
