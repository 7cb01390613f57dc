#include <array>
#include <bit>
#include <cstring>
#include <vector>

#include "core/distance/chamfer_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/chamfer_rows_simd.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#ifndef BCCSKEL_CORE_DISTANCE_RUN_TABLES_
#define BCCSKEL_CORE_DISTANCE_RUN_TABLES_
namespace bccskel {
namespace {

constexpr int kHalf = kBrickX / 2;

// Within a wide flat layer the first pass can exceed 16 bits; the far value then stands for "more
// than any final distance".
constexpr uint32_t kFar = 0xffff;
constexpr uint16_t CappedSteps(uint32_t steps) {
  const uint32_t counts = steps * kShortChamfer.axial;
  return static_cast<uint16_t>(counts < kFar ? counts : kFar);
}

// For eight points of a row, as bits: distance along x to the nearest background point among them.
struct RunTables {
  alignas(16) std::array<std::array<uint16_t, kHalf>, 256> inside;
};
constexpr RunTables MakeRunTables() {
  RunTables tables = {};
  for (uint32_t bits = 0; bits < 256; ++bits) {
    for (int i = 0; i < kHalf; ++i) {
      uint32_t nearest = kFar;
      for (int at = 0; at < kHalf; ++at) {
        const auto steps = static_cast<uint32_t>(at < i ? i - at : at - i);
        if ((bits >> at & 1) == 0 && steps < nearest) nearest = steps;
      }
      tables.inside[bits][static_cast<size_t>(i)] = CappedSteps(nearest);
    }
  }
  return tables;
}
constexpr RunTables kRunTables = MakeRunTables();

// Distances along x from the point before the first, and from the point after the last, of eight.
struct Ramps {
  alignas(16) std::array<uint16_t, kHalf> up;
  alignas(16) std::array<uint16_t, kHalf> down;
};
constexpr Ramps kRamps = [] {
  Ramps ramps = {};
  for (uint32_t i = 0; i < kHalf; ++i) {
    ramps.up[i] = CappedSteps(i + 1);
    ramps.down[i] = CappedSteps(kHalf - i);
  }
  return ramps;
}();

// How many points of each of a brick's 32 rows can be walked from one side without meeting the
// background, in this brick and the ones before it. Row 4k + j.
using RowRuns = std::array<uint16_t, 4 * kBrickZ>;

struct SideRuns {
  std::vector<RowRuns> left;   // at the brick's left side
  std::vector<RowRuns> right;  // at its right side
};

uint16_t RowBits(const BrickBits& brick, size_t row) {
  return static_cast<uint16_t>(brick.words[row >> 2] >> (16 * (row & 3)));
}

uint16_t Longer(uint32_t run) {
  return static_cast<uint16_t>(run < kLongestRun ? run : kLongestRun);
}

// The run lengths at the far side of a brick, given those at its near side.
template <typename RunInRow>
void Continue(const BrickBits& brick, const RowRuns& near_side, RowRuns& far_side,
              RunInRow run_in_row) {
  for (size_t row = 0; row < far_side.size(); ++row) {
    const uint16_t bits = RowBits(brick, row);
    far_side[row] = bits == 0xffff ? Longer(near_side[row] + uint32_t{kBrickX})
                                   : static_cast<uint16_t>(run_in_row(bits));
  }
}
void ContinueLeft(const BrickBits& brick, const RowRuns& near_side, RowRuns& far_side) {
  Continue(brick, near_side, far_side, [](uint16_t bits) { return std::countl_one(bits); });
}
void ContinueRight(const BrickBits& brick, const RowRuns& near_side, RowRuns& far_side) {
  Continue(brick, near_side, far_side, [](uint16_t bits) { return std::countr_one(bits); });
}

SideRuns FindSideRuns(const DistanceView<uint16_t>& view, BrickIndex first, BrickIndex last) {
  SideRuns runs{std::vector<RowRuns>(last - first), std::vector<RowRuns>(last - first)};
  for (BrickIndex brick = first; brick < last; ++brick) {
    const BrickIndex left = view.neighbors[brick][9];
    if (left >= first && left < brick) {
      ContinueLeft(view.object[left], runs.left[left - first], runs.left[brick - first]);
    }
  }
  for (BrickIndex brick = last; brick-- > first;) {
    const BrickIndex right = view.neighbors[brick][8];
    if (right > brick && right < last) {
      ContinueRight(view.object[right], runs.right[right - first], runs.right[brick - first]);
    }
  }
  return runs;
}

}  // namespace
}  // namespace bccskel
#endif  // tables

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RowTag = hn::CappedTag<uint16_t, kBrickX>;
using HalfTag = hn::CappedTag<uint16_t, kHalf>;
inline constexpr size_t kRowLanes =
    HWY_LANES(uint16_t) < kBrickX ? HWY_LANES(uint16_t) : size_t{kBrickX};
inline constexpr size_t kRowVectors = kBrickX / kRowLanes;

// Sixteen distances in registers.
struct Row {
  hn::Vec<RowTag> v[kRowVectors];
};

HWY_INLINE uint16_t* RowOf(const DistanceView<uint16_t>& view, BrickIndex brick, int k, int j) {
  return view.values + size_t{brick} * kBrickPoints + static_cast<size_t>(64 * k + kBrickX * j);
}
HWY_INLINE Row LoadRow(const uint16_t* values) {
  Row row;
  for (size_t n = 0; n < kRowVectors; ++n) row.v[n] = hn::LoadU(RowTag(), values + n * kRowLanes);
  return row;
}
HWY_INLINE void StoreRow(const Row& row, uint16_t* values) {
  for (size_t n = 0; n < kRowVectors; ++n) hn::StoreU(row.v[n], RowTag(), values + n * kRowLanes);
}
HWY_INLINE Row Min(const Row& a, const Row& b) {
  Row out;
  for (size_t n = 0; n < kRowVectors; ++n) out.v[n] = hn::Min(a.v[n], b.v[n]);
  return out;
}
HWY_INLINE Row Plus(const Row& a, uint32_t counts) {
  Row out;
  const auto step = hn::Set(RowTag(), static_cast<uint16_t>(counts));
  for (size_t n = 0; n < kRowVectors; ++n) out.v[n] = hn::SaturatedAdd(a.v[n], step);
  return out;
}

// The row moved by one column; the column that enters comes from `beside`.
HWY_INLINE Row FromLowerColumn(const Row& own, const Row& beside) {
  const RowTag tag;
  Row out;
  for (size_t n = 0; n < kRowVectors; ++n) {
    const auto before = n == 0 ? beside.v[kRowVectors - 1] : own.v[n - 1];
#if HWY_TARGET == HWY_SCALAR
    out.v[n] = before;
#elif HWY_TARGET <= HWY_AVX2
    out.v[n] =
        hn::CombineShiftRightBytes<14>(tag, own.v[n], hn::ConcatLowerUpper(tag, own.v[n], before));
#else
    out.v[n] = hn::CombineShiftRightBytes<14>(tag, own.v[n], before);
#endif
  }
  (void)tag;
  return out;
}
HWY_INLINE Row FromUpperColumn(const Row& own, const Row& beside) {
  const RowTag tag;
  Row out;
  for (size_t n = 0; n < kRowVectors; ++n) {
    const auto after = n + 1 == kRowVectors ? beside.v[0] : own.v[n + 1];
#if HWY_TARGET == HWY_SCALAR
    out.v[n] = after;
#elif HWY_TARGET <= HWY_AVX2
    out.v[n] =
        hn::CombineShiftRightBytes<2>(tag, hn::ConcatLowerUpper(tag, after, own.v[n]), own.v[n]);
#else
    out.v[n] = hn::CombineShiftRightBytes<2>(tag, after, own.v[n]);
#endif
  }
  (void)tag;
  return out;
}

// Distances along x of half a row whose points are `bits`, eight at a time or as many as a register
// holds; `left` and `right` are the runs beside it.
HWY_INLINE hn::Vec<HalfTag> HalfRow(uint32_t bits, uint32_t left, uint32_t right, size_t i) {
  const HalfTag tag;
  const auto from_left = hn::Set(tag, static_cast<uint16_t>(left * kShortChamfer.axial));
  const auto from_right = hn::Set(tag, static_cast<uint16_t>(right * kShortChamfer.axial));
  const auto up = hn::SaturatedAdd(from_left, hn::Load(tag, kRamps.up.data() + i));
  const auto down = hn::SaturatedAdd(from_right, hn::Load(tag, kRamps.down.data() + i));
  return hn::Min(hn::Load(tag, kRunTables.inside[bits].data() + i), hn::Min(up, down));
}

// Distances along x of a whole row. It stays in registers: reading back what was just written in
// halves would wait for the stores.
HWY_INLINE Row RowOfRuns(uint32_t bits, uint32_t left, uint32_t right) {
  const uint32_t low = bits & 0xff, high = bits >> 8;
  const auto from_low = static_cast<uint32_t>(std::countl_one(static_cast<uint8_t>(low)));
  const auto from_high = static_cast<uint32_t>(std::countr_one(static_cast<uint8_t>(high)));
  const uint32_t past_low = Longer(low == 0xff ? left + kHalf : from_low);
  const uint32_t past_high = Longer(high == 0xff ? right + kHalf : from_high);
  Row row;
#if HWY_TARGET <= HWY_AVX2
  row.v[0] =
      hn::Combine(RowTag(), HalfRow(high, past_low, right, 0), HalfRow(low, left, past_high, 0));
#else
  const size_t lanes = hn::Lanes(HalfTag());
  for (size_t n = 0; n < kRowVectors / 2; ++n) {
    row.v[n] = HalfRow(low, left, past_high, n * lanes);
    row.v[n + kRowVectors / 2] = HalfRow(high, past_low, right, n * lanes);
  }
#endif
  return row;
}

HWY_INLINE void SweepBrickForward(const DistanceView<uint16_t>& view, BrickIndex brick,
                                  const RowRuns& left, const RowRuns& right) {
  for (int k = 0; k < kBrickZ; ++k) {
    Row below = LoadRow(RowOf(view, view.neighbors[brick][11], k, kBrickY - 1));
    for (int j = 0; j < kBrickY; ++j) {
      const auto row = static_cast<size_t>(4 * k + j);
      uint16_t* values = RowOf(view, brick, k, j);
      const Row by_x = RowOfRuns(RowBits(view.object[brick], row), left[row], right[row]);
      below = Min(by_x, Plus(below, kShortChamfer.axial));
      StoreRow(below, values);
    }
  }
}

HWY_INLINE void SweepBrickBackward(const DistanceView<uint16_t>& view, BrickIndex brick) {
  for (int k = 0; k < kBrickZ; ++k) {
    Row above = LoadRow(RowOf(view, view.neighbors[brick][10], k, 0));
    for (int j = kBrickY - 1; j >= 0; --j) {
      uint16_t* values = RowOf(view, brick, k, j);
      above = Min(LoadRow(values), Plus(above, kShortChamfer.axial));
      StoreRow(above, values);
    }
  }
}

void SweepWithinLayersTarget(const DistanceView<uint16_t>& view, BrickIndex first,
                             BrickIndex last) {
  const SideRuns runs = FindSideRuns(view, first, last);
  for (BrickIndex brick = first; brick < last; ++brick) {
    SweepBrickForward(view, brick, runs.left[brick - first], runs.right[brick - first]);
  }
  for (BrickIndex brick = last; brick-- > first;) SweepBrickBackward(view, brick);
}

// One layer of one brick. Even points have their D8 neighbors in columns i - 1, i and rows j - 1, j
// of the other sublattice, odd points in i, i + 1 and j, j + 1.
template <Sublattice kSublattice>
HWY_INLINE void JoinLayer(const DistanceView<uint16_t>& view, BrickIndex brick, int k,
                          const AdjacentLayers& layers) {
  constexpr bool kEven = kSublattice == Sublattice::kEven;
  const BrickIndex* diagonal = layers.diagonal;
  const auto row_at = [&](size_t side, int j) HWY_ATTR {
    return LoadRow(RowOf(view, diagonal[side], layers.diagonal_k, j));
  };
  // Rows are visited so that the row shared by two visits is the one just read.
  Row last = row_at(2, kEven ? kBrickY - 1 : 0);
  Row last_beside = row_at(3, kEven ? kBrickY - 1 : 0);
  for (int n = 0; n < kBrickY; ++n) {
    const int j = kEven ? n : kBrickY - 1 - n;
    const Row own = row_at(0, j), own_beside = row_at(1, j);
    const Row nearest = Min(own, last), nearest_beside = Min(own_beside, last_beside);
    const Row moved =
        kEven ? FromLowerColumn(nearest, nearest_beside) : FromUpperColumn(nearest, nearest_beside);
    const Row by_diagonal = Plus(Min(nearest, moved), kShortChamfer.diagonal);
    const Row by_axis =
        Plus(LoadRow(RowOf(view, layers.axial, layers.axial_k, j)), kShortChamfer.axial);
    uint16_t* values = RowOf(view, brick, k, j);
    StoreRow(Min(LoadRow(values), Min(by_diagonal, by_axis)), values);
    last = own;
    last_beside = own_beside;
  }
}

template <Sublattice kSublattice>
void JoinLayersOf(const DistanceView<uint16_t>& view, std::span<const BrickIndex> bricks, int k,
                  ScanDirection direction) {
  for (BrickIndex brick : bricks) {
    const BrickNeighborhood& near = view.neighbors[brick];
    JoinLayer<kSublattice>(view, brick, k,
                           direction == ScanDirection::kUpward
                               ? LayersBelow(near, brick, kSublattice, k)
                               : LayersAbove(near, brick, kSublattice, k));
  }
}

void JoinLayersTarget(const DistanceView<uint16_t>& view, Sublattice sublattice,
                      std::span<const BrickIndex> bricks, int k, ScanDirection direction) {
  if (sublattice == Sublattice::kEven) {
    JoinLayersOf<Sublattice::kEven>(view, bricks, k, direction);
  } else {
    JoinLayersOf<Sublattice::kOdd>(view, bricks, k, direction);
  }
}

uint16_t LargestOfTarget(const uint16_t* values, size_t count) {
  const RowTag tag;
  Row largest;
  for (auto& v : largest.v) v = hn::Zero(tag);
  for (size_t n = 0; n < count; n += kBrickX) {
    const Row row = LoadRow(values + n);
    for (size_t v = 0; v < kRowVectors; ++v) largest.v[v] = hn::Max(largest.v[v], row.v[v]);
  }
  std::array<uint16_t, kBrickX> lanes;
  StoreRow(largest, lanes.data());
  uint16_t result = 0;
  for (const uint16_t lane : lanes) result = lane > result ? lane : result;
  return result;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(SweepWithinLayersTarget);
HWY_EXPORT(JoinLayersTarget);
HWY_EXPORT(LargestOfTarget);

void SweepWithinLayers(const DistanceView<uint16_t>& view, BrickIndex first, BrickIndex last) {
  HWY_DYNAMIC_DISPATCH(SweepWithinLayersTarget)(view, first, last);
}
void JoinLayers(const DistanceView<uint16_t>& view, Sublattice sublattice,
                std::span<const BrickIndex> bricks, int k, ScanDirection direction) {
  HWY_DYNAMIC_DISPATCH(JoinLayersTarget)(view, sublattice, bricks, k, direction);
}
uint16_t LargestOf(std::span<const uint16_t> values) {
  return HWY_DYNAMIC_DISPATCH(LargestOfTarget)(values.data(), values.size());
}

}  // namespace bccskel
#endif  // HWY_ONCE
