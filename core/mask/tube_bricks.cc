#include "core/mask/tube_bricks.h"

#include <array>
#include <utility>

namespace bccskel {
namespace {

// Words of 64 voxels, or of the 64 corners before them, by slice or layer and row.
template <int kSlices, int kRows>
using Words = std::array<std::array<uint64_t, kRows>, kSlices>;
using TubeWords = Words<RowTube::kSlices, RowTube::kRows>;
using BrickWords = Words<kBrickZ, kBrickY>;

// The phase to which the rule is applied; everything outside the mask is background.
template <MaskAdjacency kAdjacency>
uint64_t InPhase(uint64_t voxels) {
  return kAdjacency == MaskAdjacency::k26 ? voxels : ~voxels;
}

template <MaskAdjacency kAdjacency>
TubeWords WordsAt(const RowTube& tube, int32_t n) {
  TubeWords words;
  for (int s = 0; s < RowTube::kSlices; ++s) {
    for (int r = 0; r < RowTube::kRows; ++r) {
      words[static_cast<size_t>(s)][static_cast<size_t>(r)] =
          InPhase<kAdjacency>(tube.Row(s, r)[n]);
    }
  }
  return words;
}

// Voxels of a brick's own rows and of those before, which its corners touch.
uint64_t AnyVoxel(const RowTube& tube, int32_t n) {
  uint64_t any = 0;
  for (int s = 0; s + 1 < RowTube::kSlices; ++s) {
    for (int r = 0; r + 1 < RowTube::kRows; ++r) any |= tube.Row(s, r)[n];
  }
  return any;
}

// The slabs across x: bit i is set if one of the four voxels i of the rows around a corner is set.
BrickWords SlabsAcrossX(const TubeWords& v) {
  BrickWords slabs;
  for (size_t k = 0; k < kBrickZ; ++k) {
    for (size_t j = 0; j < kBrickY; ++j) {
      slabs[k][j] = v[k][j] | v[k][j + 1] | v[k + 1][j] | v[k + 1][j + 1];
    }
  }
  return slabs;
}

// Voxels i - 1 and i together.
TubeWords Widened(const TubeWords& before, const TubeWords& v) {
  TubeWords wide;
  for (size_t s = 0; s < v.size(); ++s) {
    for (size_t r = 0; r < v[s].size(); ++r) {
      wide[s][r] = v[s][r] | v[s][r] << 1 | before[s][r] >> 63;
    }
  }
  return wide;
}

// Three consecutive slabs along an axis.
uint64_t Gap(uint64_t below, uint64_t above, uint64_t next) { return below & ~above & next; }

// The even points of the phase. `x` holds the slabs across x of the word before, this one and the
// next.
BrickWords Corners(const TubeWords& wide, const std::array<BrickWords, 3>& x) {
  Words<kBrickZ, RowTube::kRows> y;  // slabs across y
  for (size_t k = 0; k < y.size(); ++k) {
    for (size_t r = 0; r < y[k].size(); ++r) y[k][r] = wide[k][r] | wide[k + 1][r];
  }
  Words<RowTube::kSlices, kBrickY> z;  // slabs across z
  for (size_t s = 0; s < z.size(); ++s) {
    for (size_t j = 0; j < z[s].size(); ++j) z[s][j] = wide[s][j] | wide[s][j + 1];
  }
  BrickWords corners;
  for (size_t k = 0; k < corners.size(); ++k) {
    for (size_t j = 0; j < corners[k].size(); ++j) {
      const uint64_t slab = x[1][k][j];
      const uint64_t gaps = Gap(slab << 1 | x[0][k][j] >> 63, slab, slab >> 1 | x[2][k][j] << 63) |
                            Gap(y[k][j], y[k][j + 1], y[k][j + 2]) |
                            Gap(z[k][j], z[k + 1][j], z[k + 2][j]);
      corners[k][j] = (y[k][j] | y[k][j + 1]) & ~gaps;
    }
  }
  return corners;
}

// Exchanges the bits of `high` under the mask with those of `low` that lie `shift` higher.
void Exchange(uint64_t& low, uint64_t& high, int shift, uint64_t mask) {
  const uint64_t change = (low >> shift ^ high) & mask;
  high ^= change;
  low ^= change << shift;
}

// Transposes words: from four rows of four times 16 points to the layers of four bricks.
std::array<uint64_t, kBrickY> LayersOf(std::array<uint64_t, kBrickY> rows) {
  constexpr uint64_t kLowHalf = 0x00000000ffffffff, kEvenLanes = 0x0000ffff0000ffff;
  Exchange(rows[0], rows[2], 32, kLowHalf);
  Exchange(rows[1], rows[3], 32, kLowHalf);
  Exchange(rows[0], rows[1], 16, kEvenLanes);
  Exchange(rows[2], rows[3], 16, kEvenLanes);
  return rows;
}

constexpr int kBricksPerWord = 64 / kBrickX;
using BrickLine = std::array<BrickBits, kBricksPerWord>;

template <MaskAdjacency kAdjacency>
BrickLine BricksOf(const BrickWords& words) {
  BrickLine bricks;
  for (size_t k = 0; k < words.size(); ++k) {
    const auto layers = LayersOf(words[k]);
    for (size_t b = 0; b < bricks.size(); ++b) bricks[b].words[k] = InPhase<kAdjacency>(layers[b]);
  }
  return bricks;
}

BrickWords OwnVoxels(const TubeWords& v) {
  BrickWords own;
  for (size_t k = 0; k < own.size(); ++k) {
    for (size_t j = 0; j < own[k].size(); ++j) own[k][j] = v[k + 1][j + 1];
  }
  return own;
}

}  // namespace

void TubeBricks::Push(BrickCoordinates brick, const BrickBits& bits) {
  if (bits.Empty()) return;
  keys_.emplace_back(brick);
  bricks_.push_back(bits);
}

template <MaskAdjacency kAdjacency>
void TubeBricks::AddTube(const RowTube& tube) {
  TubeWords before = WordsAt<kAdjacency>(tube, -1), words = WordsAt<kAdjacency>(tube, 0);
  std::array<BrickWords, 3> slabs = {{SlabsAcrossX(before), SlabsAcrossX(words), {}}};
  uint64_t any_before = 0;
  for (int32_t n = 0; n <= tube.word_count; ++n) {
    const TubeWords next = WordsAt<kAdjacency>(tube, n + 1);
    slabs[2] = SlabsAcrossX(next);
    const uint64_t any = AnyVoxel(tube, n);
    const uint64_t reach = any | any << 1 | any_before >> 63;
    if (reach != 0) {
      const BrickLine even = BricksOf<kAdjacency>(Corners(Widened(before, words), slabs));
      const BrickLine odd = BricksOf<kAdjacency>(OwnVoxels(words));
      for (size_t b = 0; b < kBricksPerWord; ++b) {
        if ((reach >> (kBrickX * b) & 0xffff) == 0) continue;
        const int32_t bx = kBricksPerWord * (tube.first_word + n) + static_cast<int32_t>(b);
        Push({bx, tube.by, tube.bz, Sublattice::kEven}, even[b]);
        Push({bx, tube.by, tube.bz, Sublattice::kOdd}, odd[b]);
      }
    }
    any_before = any;
    before = words;
    words = next;
    slabs[0] = slabs[1];
    slabs[1] = slabs[2];
  }
}

void TubeBricks::Add(const RowTube& tube) {
  if (!part_.Has(tube.bz)) return;
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
