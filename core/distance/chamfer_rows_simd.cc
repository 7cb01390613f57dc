#include <algorithm>
#include <array>
#include <bit>

#include "core/distance/chamfer_rows.h"
#include "core/distance/side_runs.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/chamfer_rows_simd.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

inline constexpr int kHalf = RunTables::kPoints;
static_assert(kHalf == kBrickX / 2);

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
HWY_INLINE hn::Vec<RowTag> StepOf(uint32_t counts) {
  return hn::Set(RowTag(), static_cast<uint16_t>(counts));
}
HWY_INLINE Row Plus(const Row& a, hn::Vec<RowTag> step) {
  Row out;
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

// Distances along x of half a row with these object `bits`, eight at a time or as many as a
// register holds; `left` and `right` are the runs beside it.
HWY_INLINE hn::Vec<HalfTag> HalfRow(const RunTables& runs, uint32_t bits, uint32_t left,
                                    uint32_t right, size_t i) {
  const HalfTag tag;
  const auto from_left = hn::Set(tag, static_cast<uint16_t>(left * runs.axial));
  const auto from_right = hn::Set(tag, static_cast<uint16_t>(right * runs.axial));
  const auto up = hn::SaturatedAdd(from_left, hn::Load(tag, runs.up.data() + i));
  const auto down = hn::SaturatedAdd(from_right, hn::Load(tag, runs.down.data() + i));
  return hn::Min(hn::Load(tag, runs.inside[bits].data() + i), hn::Min(up, down));
}

// Distances along x of a whole row. They stay in registers: reading back halves that were just
// written would wait for the stores.
HWY_INLINE Row RowOfRuns(const RunTables& runs, uint32_t bits, uint32_t left, uint32_t right) {
  const uint32_t low = bits & 0xff, high = bits >> 8;
  const auto from_low = static_cast<uint32_t>(std::countl_one(static_cast<uint8_t>(low)));
  const auto from_high = static_cast<uint32_t>(std::countr_one(static_cast<uint8_t>(high)));
  const uint32_t past_low = Shorter(low == 0xff ? left + kHalf : from_low, runs.longest_run);
  const uint32_t past_high = Shorter(high == 0xff ? right + kHalf : from_high, runs.longest_run);
  Row row;
#if HWY_TARGET <= HWY_AVX2
  row.v[0] = hn::Combine(RowTag(), HalfRow(runs, high, past_low, right, 0),
                         HalfRow(runs, low, left, past_high, 0));
#else
  const size_t lanes = hn::Lanes(HalfTag());
  for (size_t n = 0; n < kRowVectors / 2; ++n) {
    row.v[n] = HalfRow(runs, low, left, past_high, n * lanes);
    row.v[n + kRowVectors / 2] = HalfRow(runs, high, past_low, right, n * lanes);
  }
#endif
  return row;
}

HWY_INLINE void SweepBrickForward(const DistanceView<uint16_t>& view, BrickIndex brick,
                                  const RowRuns<uint16_t>& left, const RowRuns<uint16_t>& right) {
  const auto step = StepOf(view.weights.axial[1]);
  for (int k = 0; k < kBrickZ; ++k) {
    Row below = LoadRow(RowOf(view, view.neighbors[brick][11], k, kBrickY - 1));
    for (int j = 0; j < kBrickY; ++j) {
      const auto row = static_cast<size_t>(4 * k + j);
      uint16_t* values = RowOf(view, brick, k, j);
      const Row by_x =
          RowOfRuns(*view.runs, RowBits(view.object[brick], row), left[row], right[row]);
      below = Min(by_x, Plus(below, step));
      StoreRow(below, values);
    }
  }
}

HWY_INLINE void SweepBrickBackward(const DistanceView<uint16_t>& view, BrickIndex brick) {
  const auto step = StepOf(view.weights.axial[1]);
  for (int k = 0; k < kBrickZ; ++k) {
    Row above = LoadRow(RowOf(view, view.neighbors[brick][10], k, 0));
    for (int j = kBrickY - 1; j >= 0; --j) {
      uint16_t* values = RowOf(view, brick, k, j);
      above = Min(LoadRow(values), Plus(above, step));
      StoreRow(above, values);
    }
  }
}

// Outside the window no background ends a run.
void FillUnknown(const DistanceView<uint16_t>& view, BrickIndex first, BrickIndex last,
                 SideRuns<uint16_t>& runs) {
  const auto longest = static_cast<uint16_t>(view.runs->longest_run);
  for (BrickIndex brick = first; brick < last; ++brick) {
    const BrickNeighborhood& near = view.neighbors[brick];
    if (near[9] == view.unknown) runs.left[brick - first].fill(longest);
    if (near[8] == view.unknown) runs.right[brick - first].fill(longest);
  }
}

void SweepWithinLayersTarget(const DistanceView<uint16_t>& view, BrickIndex first,
                             BrickIndex last) {
  SideRuns<uint16_t> runs(last - first);
  if (view.unknown.has_value()) FillUnknown(view, first, last, runs);
  FindSideRuns(view.object, view.neighbors, first, last, view.runs->longest_run, first, runs);
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
  const auto diagonal_step = StepOf(view.weights.diagonal);
  const auto axial_step = StepOf(view.weights.axial[2]);
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
    const Row by_diagonal = Plus(Min(nearest, moved), diagonal_step);
    const Row by_axis = Plus(LoadRow(RowOf(view, layers.axial, layers.axial_k, j)), axial_step);
    uint16_t* values = RowOf(view, brick, k, j);
    StoreRow(Min(LoadRow(values), Min(by_diagonal, by_axis)), values);
    last = own;
    last_beside = own_beside;
  }
}

// The layers of consecutive bricks are a kilobyte apart, too far for hardware prefetching.
constexpr size_t kAhead = 6;
HWY_INLINE void PrefetchRows(const uint16_t* layer) {
  __builtin_prefetch(layer);
  __builtin_prefetch(layer + 2 * kBrickX);
}
HWY_INLINE void PrefetchLayer(const DistanceView<uint16_t>& view, Sublattice sublattice,
                              BrickIndex brick, int k, ScanDirection direction) {
  const BrickNeighborhood& near = view.neighbors[brick];
  const AdjacentLayers layers = direction == ScanDirection::kUpward
                                    ? LayersBelow(near, brick, sublattice, k)
                                    : LayersAbove(near, brick, sublattice, k);
  PrefetchRows(RowOf(view, brick, k, 0));
  PrefetchRows(RowOf(view, layers.diagonal[0], layers.diagonal_k, 0));
  PrefetchRows(RowOf(view, layers.axial, layers.axial_k, 0));
}

template <Sublattice kSublattice>
void JoinLayersOf(const DistanceView<uint16_t>& view, std::span<const BrickIndex> bricks, int k,
                  ScanDirection direction) {
  for (size_t n = 0; n < bricks.size(); ++n) {
    const BrickIndex brick = bricks[n];
    PrefetchLayer(view, kSublattice, bricks[std::min(n + kAhead, bricks.size() - 1)], k, direction);
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

namespace {

constexpr uint32_t kPoints = RunTables::kPoints;

uint16_t CappedSteps(uint32_t steps, uint32_t axial) {
  return static_cast<uint16_t>(std::min(steps * axial, RunTables::kFar));
}

}  // namespace

bool FitShortRows(const ChamferWeights& weights) {
  return std::max(weights.diagonal, std::ranges::max(weights.axial)) < 0x4000;
}

RunTables RunTablesFor(const ChamferWeights& weights) {
  RunTables tables;
  tables.axial = weights.axial[0];
  tables.longest_run = RunTables::kFar / tables.axial - 2;
  for (uint32_t i = 0; i < kPoints; ++i) {
    tables.up[i] = CappedSteps(i + 1, tables.axial);
    tables.down[i] = CappedSteps(kPoints - i, tables.axial);
  }
  for (uint32_t bits = 0; bits < 256; ++bits) {
    for (uint32_t i = 0; i < kPoints; ++i) {
      uint32_t nearest = kPoints;
      for (uint32_t at = 0; at < kPoints; ++at) {
        if ((bits >> at & 1) == 0) nearest = std::min(nearest, at < i ? i - at : at - i);
      }
      tables.inside[bits][i] =
          nearest == kPoints ? uint16_t{RunTables::kFar} : CappedSteps(nearest, tables.axial);
    }
  }
  return tables;
}

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
