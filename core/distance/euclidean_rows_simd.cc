#include <algorithm>
#include <cstdint>
#include <limits>

#include "core/distance/euclidean_rows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/euclidean_rows_simd.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/distance/row_ends-inl.h"
#include "hwy/highway.h"
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// A vector of at most 64 bytes: a row of floats, or two rows of integers.
template <typename T>
using Tag = hn::CappedTag<T, 64 / sizeof(T)>;
template <typename T>
using Vector = hn::Vec<Tag<T>>;
// The number of points of the rows that are processed together.
template <typename T>
inline constexpr size_t kBandPoints = 64 / sizeof(T);

// Padding rows on either side of a stack. Two rows search outward together, two steps at a time, so
// one may read three rows past the first row of background. Unknown points stop no search.
template <typename T>
constexpr size_t EndRows(StackEnds ends) {
  return ends.AreKnown() ? 4 : kMostEndRows<T>;
}

// Far from all background.
template <typename T>
constexpr T Far() {
  return std::numeric_limits<T>::has_infinity ? std::numeric_limits<T>::infinity()
                                              : std::numeric_limits<T>::max();
}

HWY_INLINE Vector<float> Sum(Vector<float> a, Vector<float> b) { return hn::Add(a, b); }
HWY_INLINE Vector<uint16_t> Sum(Vector<uint16_t> a, Vector<uint16_t> b) {
  return hn::SaturatedAdd(a, b);
}

// The most steps of a search outward, which takes one per unit of distance. Floats stop when the
// search of a whole column would take no longer; integers saturate after 256 units.
template <typename T>
inline constexpr size_t kMostSteps = 512;
template <>
inline constexpr size_t kMostSteps<float> = 16;
static_assert(kMostSteps<float> + 3 < kMostEndRows<float>);

// Lowers `best` to the minimum of the rows ever farther to both sides, each plus the square of its
// distance: the n-th pair of rows, kPitch values apart, is squares[n * kStride] away. All values of
// rows are at least `least`. Returns whether nothing nearer can be farther away.
template <size_t kStride, size_t kPitch, typename T>
HWY_INLINE bool LookOutward(Vector<T>& best, const T* before, const T* after, const T* squares,
                            T least) {
  const Tag<T> tag;
  const auto nearest = hn::Set(tag, least);
  const auto look = [&](Vector<T> square) HWY_ATTR {
    best = hn::Min(best, Sum(hn::Min(hn::LoadU(tag, before), hn::LoadU(tag, after)), square));
    before -= kPitch;
    after += kPitch;
  };
  for (size_t step = 0; step < kMostSteps<T>; step += 2, squares += 2 * kStride) {
    const auto square = hn::Set(tag, squares[0]);
    if (hn::AllFalse(tag, hn::Gt(best, Sum(square, nearest)))) return true;
    look(square);
    look(hn::Set(tag, squares[kStride]));
  }
  return false;
}

// The rows of one layer of a stack along y, with rows of background before and after.
template <typename T>
struct LayerRows {
  LayerRows(size_t bricks, StackEnds ends, T unit_square)
      : end_rows(EndRows<T>(ends)),
        own((kBrickY * bricks + 2 * end_rows) * kBrickX),
        between((kBrickY * bricks + 2 * end_rows) * kBrickX, unit_square) {
    for (std::vector<T>* rows : {&own, &between}) {
      if (ends.unknown_before) std::fill_n(rows->begin(), end_rows * kBrickX, Far<T>());
      if (ends.unknown_after) std::fill_n(rows->rbegin(), end_rows * kBrickX, Far<T>());
    }
  }
  size_t end_rows;
  std::vector<T> own;
  std::vector<T> between;
};

template <typename T>
HWY_INLINE void ReadLayer(const EuclideanView<T>& view, T unit_square, BrickStack stack, size_t k,
                          const SideRuns<uint32_t>& runs, Sublattice sublattice,
                          LayerRows<T>& rows) {
  size_t at = rows.end_rows * kBrickX;
  const auto fill = [&](T own, T between) {
    std::fill_n(rows.own.begin() + static_cast<ptrdiff_t>(at), kBrickX, own);
    std::fill_n(rows.between.begin() + static_cast<ptrdiff_t>(at), kBrickX, between);
  };
  for (BrickIndex brick : stack) {
    for (size_t row = 4 * k; row < 4 * k + 4; ++row, at += kBrickX) {
      const uint16_t bits = RowBits(view.object[brick], row);
      if (bits == 0) {
        fill(T{0}, unit_square);
        continue;
      }
      if (bits == 0xffff &&
          std::min(runs.left[brick][row], runs.right[brick][row]) >= kUnknownRun) {
        fill(Far<T>(), Far<T>());
        continue;
      }
      const RowEnds ends = {bits ^ 0xffff, static_cast<int32_t>(runs.left[brick][row]),
                            static_cast<int32_t>(runs.right[brick][row])};
      MeasureRow(ends, sublattice, unit_square, rows.own.data() + at, rows.between.data() + at);
    }
  }
}

// Measures a brick's rows of a layer. Returns whether they are settled, as do the functions below.
template <typename T>
HWY_INLINE bool WriteOwnRows(const SquaredLengths<T>& lengths, const T* rows, T* to) {
  const Tag<T> tag;
  for (size_t i = 0; i < kLayerPoints; i += hn::Lanes(tag)) {
    const T* at = rows + i;
    auto best = hn::LoadU(tag, at);
    if (!LookOutward<2, kBrickX, T>(best, at - kBrickX, at + kBrickX, lengths.y.data() + 2, 0)) {
      return false;
    }
    hn::StoreU(best, tag, to + i);
  }
  return true;
}

// Measures the positions between those rows and the next ones.
template <typename T>
HWY_INLINE bool WriteBetween(const SquaredLengths<T>& lengths, const T* rows, T* to) {
  const Tag<T> tag;
  for (size_t i = 0; i < kLayerPoints; i += hn::Lanes(tag)) {
    const T* at = rows + i;
    const auto nearest = hn::Min(hn::LoadU(tag, at), hn::LoadU(tag, at + kBrickX));
    auto best = Sum(nearest, hn::Set(tag, lengths.y[1]));
    if (!LookOutward<2, kBrickX, T>(best, at - kBrickX, at + 2 * kBrickX, lengths.y.data() + 3,
                                    lengths.x)) {
      return false;
    }
    hn::StoreU(best, tag, to + i);
  }
  return true;
}

// A brick's band of rows in all its layers, from a column of both sublattices.
template <typename T>
HWY_INLINE bool WriteAcross(const SquaredLengths<T>& lengths, const T* row, T* to) {
  const Tag<T> tag;
  constexpr size_t kBand = kBandPoints<T>;
  for (size_t k = 0; k < kBrickZ; ++k, to += kLayerPoints, row += 2 * kBand) {
    for (size_t i = 0; i < kBand; i += hn::Lanes(tag)) {
      const T* at = row + i;
      auto best = hn::LoadU(tag, at);
      if (!LookOutward<1, kBand, T>(best, at - kBand, at + kBand, lengths.z.data() + 1, 0)) {
        return false;
      }
      hn::StoreU(best, tag, to + i);
    }
  }
  return true;
}

// The destination of the distances between the points of layer k of a brick; null if they are not
// needed.
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

// Searches the rows of a column, `step` units apart, where searching outward takes too long. The
// farther along the column a position is, the farther along is the row that determines its
// distance. So the row for the middle position splits the rows for the positions on either side,
// and a column takes a few steps per row instead of one per unit of distance.
// Source: Aggarwal, Klawe, Moran, Shor and Wilber, Geometric applications of a matrix-searching
//         algorithm, 1987.
template <typename T>
class Column {
 public:
  Column(std::span<const T> rows, size_t step, std::span<const T> squares)
      : rows_(rows), step_(step), squares_(squares) {}

  bool is_settled() const { return !settled_.empty(); }
  // Settles `count` rows 2 units apart; `place` is the distance of the first one from the first row
  // of the column.
  HWY_INLINE void Settle(size_t place, size_t count) {
    first_place_ = place;
    settled_.resize(count * kBandPoints<T>);
    Search(0, count, {0, rows_.size() / kBandPoints<T> - 1});
  }
  // Writes `count` settled rows from the n-th on, `pitch` values apart.
  void Write(size_t n, size_t count, size_t pitch, T* to) const {
    for (const size_t end = n + count; n < end; ++n, to += pitch) {
      std::copy_n(settled_.data() + n * kBandPoints<T>, kBandPoints<T>, to);
    }
  }

 private:
  struct RowRange {
    size_t first = 0;
    size_t last = 0;
  };

  // Settles positions begin..end - 1, whose distances come from `rows`.
  void Search(size_t begin, size_t end, RowRange rows) {
    if (begin == end) return;
    const size_t middle = begin + (end - begin) / 2;
    const RowRange nearest = TakeLeast(middle, rows);
    Search(begin, middle, {rows.first, nearest.last});
    Search(middle + 1, end, {nearest.first, rows.last});
  }

  // For all points of a row together: results must not depend on the size of vectors.
  HWY_INLINE RowRange TakeLeast(size_t n, RowRange rows) {
    const Tag<T> tag;
    const size_t place = first_place_ + 2 * n;
    const T* squares = squares_.data();
    const auto one = hn::Set(tag, T{1}), none = hn::Set(tag, hwy::HighestValue<T>());
    const auto first_row = hn::Set(tag, static_cast<T>(rows.first));
    const auto last_row = hn::Set(tag, static_cast<T>(rows.last));
    RowRange nearest = {rows.last, rows.first};
    for (size_t i = 0; i < kBandPoints<T>; i += hn::Lanes(tag)) {
      auto best = none, at = first_row, from = at;
      const T* values = rows_.data() + rows.first * kBandPoints<T> + i;
      for (size_t row = rows.first; row <= rows.last; ++row, values += kBandPoints<T>) {
        const size_t foot = row * step_;
        const T square = squares[foot < place ? place - foot : foot - place];
        const auto sum = Sum(hn::LoadU(tag, values), hn::Set(tag, square));
        from = hn::IfThenElse(hn::Lt(sum, best), at, from);
        best = hn::Min(best, sum);
        at = hn::Add(at, one);
      }
      hn::StoreU(best, tag, settled_.data() + n * kBandPoints<T> + i);
      // Points far from all background get their distances from no row.
      const auto is_far = hn::Eq(best, none);
      const auto least = hn::IfThenElse(is_far, last_row, from);
      const auto most = hn::IfThenElse(is_far, first_row, from);
      const auto first = static_cast<size_t>(hn::GetLane(hn::MinOfLanes(tag, least)));
      const auto last = static_cast<size_t>(hn::GetLane(hn::MaxOfLanes(tag, most)));
      nearest = {std::min(nearest.first, first), std::max(nearest.last, last)};
    }
    return nearest;
  }

  std::span<const T> rows_;
  size_t step_;
  std::span<const T> squares_;
  size_t first_place_ = 0;
  std::vector<T> settled_;
};

template <typename T>
HWY_INLINE void ScanLayersOf(const EuclideanView<T>& view, const SquaredLengths<T>& lengths,
                             Sublattice sublattice, BrickStack stack, StackEnds ends,
                             LayersOfBrick layers, const SideRuns<uint32_t>& runs) {
  LayerRows<T> rows(stack.size(), ends, lengths.x);
  // The position that belongs to a row lies after it for even points, before it for odd ones.
  const size_t back = sublattice == Sublattice::kEven ? 0 : 1;
  const size_t count = kBrickY * stack.size();
  for (size_t k = layers.first; k < layers.end; ++k) {
    ReadLayer(view, lengths.x, stack, k, runs, sublattice, rows);
    Column<T> own(rows.own, 2, lengths.y), between(rows.between, 2, lengths.y);
    size_t at = rows.end_rows * kBrickX;
    for (size_t n = 0; n < stack.size(); ++n, at += kLayerPoints) {
      T* to = view.own + size_t{stack[n]} * kBrickPoints + k * kLayerPoints;
      if (!own.is_settled() && !WriteOwnRows(lengths, rows.own.data() + at, to)) {
        own.Settle(2 * rows.end_rows, count);
      }
      if (own.is_settled()) own.Write(n * kBrickY, kBrickY, kBrickX, to);
      T* beside = BesideLayer(view, stack[n], sublattice, k);
      if (beside == nullptr) continue;
      const T* places = rows.between.data() + at - back * kBrickX;
      if (!between.is_settled() && !WriteBetween(lengths, places, beside)) {
        between.Settle(2 * (rows.end_rows - back) + 1, count);
      }
      if (between.is_settled()) between.Write(n * kBrickY, kBrickY, kBrickX, beside);
    }
  }
}

// A band of rows in all layers of a stack along z, those of the other sublattice in between, and
// background below and above.
template <typename T>
HWY_INLINE void ReadColumn(const EuclideanView<T>& view, BrickStack stack, Sublattice sublattice,
                           size_t first, size_t end_rows, std::vector<T>& column) {
  constexpr size_t kBand = kBandPoints<T>;
  const bool even = sublattice == Sublattice::kEven;
  const auto beside = [&](BrickIndex brick, size_t layer) {
    return view.beside + (size_t{brick} * kLayersBeside + layer) * kLayerPoints + first;
  };
  T* to = column.data() + (end_rows - 1) * kBand;
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
                                   Sublattice sublattice, BrickStack stack, StackEnds ends) {
  constexpr size_t kBand = kBandPoints<T>;
  const size_t end_rows = EndRows<T>(ends);
  std::vector<T> rows((2 * kBrickZ * stack.size() + 2 * end_rows) * kBand);
  if (ends.unknown_before) std::fill_n(rows.begin(), end_rows * kBand, Far<T>());
  if (ends.unknown_after) std::fill_n(rows.rbegin(), end_rows * kBand, Far<T>());
  for (size_t first = 0; first < kLayerPoints; first += kBand) {
    ReadColumn(view, stack, sublattice, first, end_rows, rows);
    Column<T> column(rows, 1, lengths.z);
    const T* row = rows.data() + end_rows * kBand;
    for (size_t n = 0; n < stack.size(); ++n, row += 2 * kBrickZ * kBand) {
      T* to = view.own + size_t{stack[n]} * kBrickPoints + first;
      if (!column.is_settled() && !WriteAcross(lengths, row, to)) {
        column.Settle(end_rows, kBrickZ * stack.size());
      }
      if (column.is_settled()) column.Write(n * kBrickZ, kBrickZ, kLayerPoints, to);
    }
  }
}

void ScanLayersFloat(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                     Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                     const SideRuns<uint32_t>& runs) {
  ScanLayersOf(view, lengths, sublattice, stack, ends, layers, runs);
}
void ScanLayersWhole(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                     Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                     const SideRuns<uint32_t>& runs) {
  ScanLayersOf(view, lengths, sublattice, stack, ends, layers, runs);
}
void ScanAcrossLayersFloat(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                           Sublattice sublattice, BrickStack stack, StackEnds ends) {
  ScanAcrossLayersOf(view, lengths, sublattice, stack, ends);
}
void ScanAcrossLayersWhole(const EuclideanView<uint16_t>& view,
                           const SquaredLengths<uint16_t>& lengths, Sublattice sublattice,
                           BrickStack stack, StackEnds ends) {
  ScanAcrossLayersOf(view, lengths, sublattice, stack, ends);
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
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs) {
  HWY_DYNAMIC_DISPATCH(ScanLayersFloat)(view, lengths, sublattice, stack, ends, layers, runs);
}
void ScanLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                Sublattice sublattice, BrickStack stack, StackEnds ends, LayersOfBrick layers,
                const SideRuns<uint32_t>& runs) {
  HWY_DYNAMIC_DISPATCH(ScanLayersWhole)(view, lengths, sublattice, stack, ends, layers, runs);
}
void ScanAcrossLayers(const EuclideanView<float>& view, const SquaredLengths<float>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends) {
  HWY_DYNAMIC_DISPATCH(ScanAcrossLayersFloat)(view, lengths, sublattice, stack, ends);
}
void ScanAcrossLayers(const EuclideanView<uint16_t>& view, const SquaredLengths<uint16_t>& lengths,
                      Sublattice sublattice, BrickStack stack, StackEnds ends) {
  HWY_DYNAMIC_DISPATCH(ScanAcrossLayersWhole)(view, lengths, sublattice, stack, ends);
}

}  // namespace bccskel
#endif  // HWY_ONCE
