#include <algorithm>
#include <array>
#include <cstdint>

#include "core/distance/euclidean_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/euclidean_rows_simd.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector of 64 bytes at most: a row of floats, or two rows of whole numbers.
template <typename T>
using Tag = hn::CappedTag<T, 64 / sizeof(T)>;
template <typename T>
using Vector = hn::Vec<Tag<T>>;
// Rows that are looked at together have as many points.
template <typename T>
inline constexpr size_t kBandPoints = 64 / sizeof(T);

// Rows of background on either side of a stack. Two rows look outward together, two steps at a
// time: one of them may look three rows past the first of background.
inline constexpr size_t kBorderRows = 4;

HWY_INLINE Vector<float> Sum(Vector<float> a, Vector<float> b) { return hn::Add(a, b); }
HWY_INLINE Vector<uint16_t> Sum(Vector<uint16_t> a, Vector<uint16_t> b) {
  return hn::SaturatedAdd(a, b);
}

using RunTag = hn::CappedTag<int32_t, kBrickX>;
using Run = hn::Vec<RunTag>;

// The bits 0..i of 16, for i from -1 to 15.
alignas(64) constexpr std::array<int32_t, kBrickX + 1> kBitsUpTo = {
    0x0000, 0x0001, 0x0003, 0x0007, 0x000f, 0x001f, 0x003f, 0x007f, 0x00ff,
    0x01ff, 0x03ff, 0x07ff, 0x0fff, 0x1fff, 0x3fff, 0x7fff, 0xffff};

// The highest bit, or `none` where there is none: whole numbers of 16 bits are exact as floats,
// whose exponent tells. Without branches, since rows at a boundary come in all kinds.
HWY_INLINE Run HighestBit(Run bits, int32_t none) {
  const RunTag ints;
  const auto exponent =
      hn::ShiftRight<23>(hn::BitCast(ints, hn::ConvertTo(hn::RebindToFloat<RunTag>(), bits)));
  return hn::IfThenElse(hn::Eq(bits, hn::Zero(ints)), hn::Set(ints, none),
                        hn::Sub(exponent, hn::Set(ints, 127)));
}

// A row's background, and how far the object goes on beside it, in points.
struct RowEnds {
  int32_t background;  // a bit per point
  int32_t left;
  int32_t right;

  // How many object points there are in a row: up to point i, and from point i on.
  HWY_INLINE Run UpTo(int32_t i) const {
    const RunTag ints;
    const auto bits =
        hn::And(hn::Set(ints, background), hn::LoadU(ints, &kBitsUpTo[Position(i + 1)]));
    return hn::Sub(hn::Iota(ints, i), HighestBit(bits, -1 - left));
  }
  HWY_INLINE Run From(int32_t i) const {
    const RunTag ints;
    const auto bits =
        hn::AndNot(hn::LoadU(ints, &kBitsUpTo[Position(i)]), hn::Set(ints, background));
    const auto lowest = hn::And(bits, hn::Neg(bits));
    return hn::Sub(HighestBit(lowest, kBrickX + right), hn::Iota(ints, i));
  }
  static size_t Position(int32_t i) { return static_cast<size_t>(i); }
};

// Stores the squared lengths of `units` lattice units along x.
HWY_INLINE void StoreSquares(Run units, float unit_square, float* to) {
  const hn::RebindToFloat<RunTag> tag;
  const auto length = hn::ConvertTo(tag, units);
  hn::StoreU(hn::Mul(hn::Mul(length, length), hn::Set(tag, unit_square)), tag, to);
}
HWY_INLINE void StoreSquares(Run units, uint16_t, uint16_t* to) {
  const hn::Rebind<uint16_t, RunTag> tag;
  const auto length = hn::Min(units, hn::Set(RunTag(), 255));
  hn::StoreU(hn::DemoteTo(tag, hn::Mul(length, length)), tag, to);
}

// Squared distances along x to the background of a row: at its points, and at the places between
// them, which lie to the right of even points and to the left of odd ones.
template <typename T>
HWY_INLINE void MeasureRow(const RowEnds& row, Sublattice sublattice, T unit_square, T* own,
                           T* between) {
  const RunTag ints;
  const bool even = sublattice == Sublattice::kEven;
  for (int32_t i = 0; i < kBrickX; i += static_cast<int32_t>(hn::Lanes(ints))) {
    const auto up_to = row.UpTo(i), from = row.From(i);
    const auto run = hn::Min(up_to, from);
    const auto run_between =
        even ? hn::Min(up_to, row.From(i + 1)) : hn::Min(row.UpTo(i - 1), from);
    StoreSquares(hn::Add(run, run), unit_square, own + i);
    const auto odd = hn::Add(hn::Add(run_between, run_between), hn::Set(ints, 1));
    StoreSquares(odd, unit_square, between + i);
  }
}

// The least of `best` and of what rows ever farther to both sides add to the squares of their
// distances: the n-th pair of rows, kPitch values apart, lies squares[n * kStride] away. Rows hold
// at least `least`.
template <size_t kStride, size_t kPitch, typename T>
HWY_INLINE Vector<T> LookOutward(Vector<T> best, const T* before, const T* after, const T* squares,
                                 T least) {
  const Tag<T> tag;
  const auto nearest = hn::Set(tag, least);
  const auto look = [&](Vector<T> square) HWY_ATTR {
    best = hn::Min(best, Sum(hn::Min(hn::LoadU(tag, before), hn::LoadU(tag, after)), square));
    before -= kPitch;
    after += kPitch;
  };
  for (;; squares += 2 * kStride) {
    const auto square = hn::Set(tag, squares[0]);
    if (hn::AllFalse(tag, hn::Gt(best, Sum(square, nearest)))) return best;
    look(square);
    look(hn::Set(tag, squares[kStride]));
  }
}

// The rows of one layer of a stack along y, with rows of background before and after.
template <typename T>
struct LayerRows {
  LayerRows(size_t bricks, T unit_square)
      : own((kBrickY * bricks + 2 * kBorderRows) * kBrickX),
        between((kBrickY * bricks + 2 * kBorderRows) * kBrickX, unit_square) {}
  std::vector<T> own;
  std::vector<T> between;
};

template <typename T>
HWY_INLINE void ReadLayer(const EuclideanView<T>& view, T unit_square, BrickStack stack, size_t k,
                          const SideRuns<uint32_t>& runs, BrickIndex first, Sublattice sublattice,
                          LayerRows<T>& rows) {
  size_t at = kBorderRows * kBrickX;
  for (BrickIndex brick : stack) {
    for (size_t row = 4 * k; row < 4 * k + 4; ++row, at += kBrickX) {
      const uint16_t bits = RowBits(view.object[brick], row);
      if (bits == 0) {
        std::fill_n(rows.own.begin() + static_cast<ptrdiff_t>(at), kBrickX, T{0});
        std::fill_n(rows.between.begin() + static_cast<ptrdiff_t>(at), kBrickX, unit_square);
        continue;
      }
      const RowEnds ends = {bits ^ 0xffff, static_cast<int32_t>(runs.left[brick - first][row]),
                            static_cast<int32_t>(runs.right[brick - first][row])};
      MeasureRow(ends, sublattice, unit_square, rows.own.data() + at, rows.between.data() + at);
    }
  }
}

// A brick's rows of a layer.
template <typename T>
HWY_INLINE void WriteOwnRows(const SquaredLengths<T>& lengths, const T* rows, T* to) {
  const Tag<T> tag;
  for (size_t i = 0; i < kLayerPoints; i += hn::Lanes(tag)) {
    const T* at = rows + i;
    const auto best = LookOutward<2, kBrickX, T>(hn::LoadU(tag, at), at - kBrickX, at + kBrickX,
                                                 lengths.y.data() + 2, 0);
    hn::StoreU(best, tag, to + i);
  }
}

// The places between those rows and the next ones.
template <typename T>
HWY_INLINE void WriteBetween(const SquaredLengths<T>& lengths, const T* rows, T* to) {
  const Tag<T> tag;
  for (size_t i = 0; i < kLayerPoints; i += hn::Lanes(tag)) {
    const T* at = rows + i;
    const auto nearest = hn::Min(hn::LoadU(tag, at), hn::LoadU(tag, at + kBrickX));
    const auto best =
        LookOutward<2, kBrickX, T>(Sum(nearest, hn::Set(tag, lengths.y[1])), at - kBrickX,
                                   at + 2 * kBrickX, lengths.y.data() + 3, lengths.x);
    hn::StoreU(best, tag, to + i);
  }
}

// Where the distances between the points of layer k of a brick go; null if nobody needs them.
template <typename T>
HWY_INLINE T* BesideLayer(const EuclideanView<T>& view, BrickIndex brick, Sublattice sublattice,
                          size_t k) {
  const BrickNeighborhood& near = view.neighbors[brick];
  const auto layer = [&](BrickIndex n, size_t which) {
    return view.beside + (size_t{n} * kLayersBeside + which) * kLayerPoints;
  };
  if (near[0] != view.padding) return layer(near[0], k);
  const bool is_outermost = k == (sublattice == Sublattice::kEven ? 0 : kBrickZ - 1);
  return is_outermost && near[4] != view.padding ? layer(near[4], kBrickZ) : nullptr;
}

template <typename T>
HWY_INLINE void ScanLayersOf(const EuclideanView<T>& view, const SquaredLengths<T>& lengths,
                             Sublattice sublattice, BrickStack stack,
                             const SideRuns<uint32_t>& runs, BrickIndex first) {
  LayerRows<T> rows(stack.size(), lengths.x);
  // The place that belongs to a row lies after it for even points, before it for odd ones.
  const size_t back = sublattice == Sublattice::kEven ? 0 : kBrickX;
  for (size_t k = 0; k < kBrickZ; ++k) {
    ReadLayer(view, lengths.x, stack, k, runs, first, sublattice, rows);
    size_t at = kBorderRows * kBrickX;
    for (size_t n = 0; n < stack.size(); ++n, at += kLayerPoints) {
      T* own = view.own + size_t{stack[n]} * kBrickPoints + k * kLayerPoints;
      WriteOwnRows(lengths, rows.own.data() + at, own);
      T* beside = BesideLayer(view, stack[n], sublattice, k);
      if (beside != nullptr) WriteBetween(lengths, rows.between.data() + at - back, beside);
    }
  }
}

// A band of rows in all layers of a stack along z, those of the other sublattice in between, and
// background below and above.
template <typename T>
HWY_INLINE void ReadColumn(const EuclideanView<T>& view, BrickStack stack, Sublattice sublattice,
                           size_t first, std::vector<T>& column) {
  constexpr size_t kBand = kBandPoints<T>;
  const bool even = sublattice == Sublattice::kEven;
  const auto beside = [&](BrickIndex brick, size_t layer) {
    return view.beside + (size_t{brick} * kLayersBeside + layer) * kLayerPoints + first;
  };
  T* to = column.data() + (kBorderRows - 1) * kBand;
  const auto add = [&to](const T* rows) { to = std::copy_n(rows, kBand, to); };
  if (even) add(beside(stack.front(), kBrickZ));
  for (BrickIndex brick : stack) {
    const T* own = view.own + size_t{brick} * kBrickPoints + first;
    for (size_t k = 0; k < kBrickZ; ++k, own += kLayerPoints) {
      if (even) {
        add(own);
        add(beside(brick, k));
      } else {
        add(beside(brick, k));
        add(own);
      }
    }
  }
  if (!even) add(beside(stack.back(), kBrickZ));
}

template <typename T>
HWY_INLINE void ScanAcrossLayersOf(const EuclideanView<T>& view, const SquaredLengths<T>& lengths,
                                   Sublattice sublattice, BrickStack stack) {
  const Tag<T> tag;
  constexpr size_t kBand = kBandPoints<T>;
  std::vector<T> column((2 * kBrickZ * stack.size() + 2 * kBorderRows) * kBand);
  for (size_t first = 0; first < kLayerPoints; first += kBand) {
    ReadColumn(view, stack, sublattice, first, column);
    const T* row = column.data() + kBorderRows * kBand;
    for (BrickIndex brick : stack) {
      T* own = view.own + size_t{brick} * kBrickPoints + first;
      for (size_t k = 0; k < kBrickZ; ++k, own += kLayerPoints, row += 2 * kBand) {
        for (size_t i = 0; i < kBand; i += hn::Lanes(tag)) {
          const T* at = row + i;
          hn::StoreU(LookOutward<1, kBand, T>(hn::LoadU(tag, at), at - kBand, at + kBand,
                                              lengths.z.data() + 1, 0),
                     tag, own + i);
        }
      }
    }
  }
}

void ScanLayersFloat(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                     Sublattice sublattice, BrickStack stack, const SideRuns<uint32_t>& runs,
                     BrickIndex first) {
  ScanLayersOf(view, lengths, sublattice, stack, runs, first);
}
void ScanLayersWhole(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                     Sublattice sublattice, BrickStack stack, const SideRuns<uint32_t>& runs,
                     BrickIndex first) {
  ScanLayersOf(view, lengths, sublattice, stack, runs, first);
}
void ScanAcrossLayersFloat(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                           Sublattice sublattice, BrickStack stack) {
  ScanAcrossLayersOf(view, lengths, sublattice, stack);
}
void ScanAcrossLayersWhole(const EuclideanView<uint16_t>& view,
                           const SquaredLengths<uint16_t>& lengths, Sublattice sublattice,
                           BrickStack stack) {
  ScanAcrossLayersOf(view, lengths, sublattice, stack);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {
HWY_EXPORT(ScanLayersFloat);
HWY_EXPORT(ScanLayersWhole);
HWY_EXPORT(ScanAcrossLayersFloat);
HWY_EXPORT(ScanAcrossLayersWhole);

void ScanLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                Sublattice sublattice, BrickStack stack, const SideRuns<uint32_t>& runs,
                BrickIndex first) {
  HWY_DYNAMIC_DISPATCH(ScanLayersFloat)(view, lengths, sublattice, stack, runs, first);
}
void ScanLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                Sublattice sublattice, BrickStack stack, const SideRuns<uint32_t>& runs,
                BrickIndex first) {
  HWY_DYNAMIC_DISPATCH(ScanLayersWhole)(view, lengths, sublattice, stack, runs, first);
}
void ScanAcrossLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                      Sublattice sublattice, BrickStack stack) {
  HWY_DYNAMIC_DISPATCH(ScanAcrossLayersFloat)(view, lengths, sublattice, stack);
}
void ScanAcrossLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                      Sublattice sublattice, BrickStack stack) {
  HWY_DYNAMIC_DISPATCH(ScanAcrossLayersWhole)(view, lengths, sublattice, stack);
}

}  // namespace bccskel
#endif  // HWY_ONCE
