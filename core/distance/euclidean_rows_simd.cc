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

using Floats = hn::CappedTag<float, kBrickX>;
using Ints = hn::RebindToSigned<Floats>;
using Vector = hn::Vec<Floats>;

// Runs of object points that end at, and begin at, the points of a row, in points; one more at the
// side that the row's places between points need.
struct PointRuns {
  alignas(64) std::array<int32_t, kBrickX + 1> leftward;   // [i + 1] of point i
  alignas(64) std::array<int32_t, kBrickX + 1> rightward;  // [i] of point i
};

HWY_INLINE void FindPointRuns(uint32_t bits, uint32_t left, uint32_t right, PointRuns& runs) {
  if (bits == 0xffff) {  // most rows of a thick object
    for (uint32_t i = 0; i <= kBrickX; ++i) {
      runs.leftward[i] = static_cast<int32_t>(left + i);
      runs.rightward[i] = static_cast<int32_t>(right + kBrickX - i);
    }
    return;
  }
  auto run = static_cast<int32_t>(left);
  runs.leftward[0] = run;
  for (size_t i = 0; i < kBrickX; ++i) {
    run = (bits >> i & 1) != 0 ? run + 1 : 0;
    runs.leftward[i + 1] = run;
  }
  run = static_cast<int32_t>(right);
  runs.rightward[kBrickX] = run;
  for (size_t i = kBrickX; i-- > 0;) {
    run = (bits >> i & 1) != 0 ? run + 1 : 0;
    runs.rightward[i] = run;
  }
}

// The squared length of `units` lattice units along x.
HWY_INLINE Vector SquareAlongX(hn::Vec<Ints> units, Vector unit_square) {
  const auto length = hn::ConvertTo(Floats(), units);
  return hn::Mul(hn::Mul(length, length), unit_square);
}

// Squared distances along x to the background of a row: at its points, and at the places between
// them, which lie to the right of even points and to the left of odd ones.
HWY_INLINE void MeasureRow(const PointRuns& runs, Sublattice sublattice, float unit_square,
                           float* own, float* between) {
  const Ints ints;
  const auto unit = hn::Set(Floats(), unit_square);
  const int32_t* left = runs.leftward.data();
  const int32_t* right = runs.rightward.data();
  const size_t beside = sublattice == Sublattice::kEven ? 1 : 0;
  for (size_t i = 0; i < kBrickX; i += hn::Lanes(ints)) {
    const auto points = hn::Min(hn::LoadU(ints, left + i + 1), hn::LoadU(ints, right + i));
    const auto between_points =
        hn::Min(hn::LoadU(ints, left + i + beside), hn::LoadU(ints, right + i + beside));
    hn::StoreU(SquareAlongX(hn::Add(points, points), unit), Floats(), own + i);
    const auto odd = hn::Add(hn::Add(between_points, between_points), hn::Set(ints, 1));
    hn::StoreU(SquareAlongX(odd, unit), Floats(), between + i);
  }
}

// The least of `best` and of what rows ever farther to both sides add to the squares of their
// distances: the n-th pair of rows lies squares[n * kStride] away. Rows hold at least `least`.
template <size_t kStride>
HWY_INLINE Vector LookOutward(Vector best, const float* before, const float* after,
                              const float* squares, float least) {
  const Floats tag;
  for (size_t n = 0;; ++n) {
    const auto square = hn::Set(tag, squares[n * kStride]);
    if (hn::AllFalse(tag, hn::Gt(best, hn::Add(square, hn::Set(tag, least))))) return best;
    const auto nearer =
        hn::Min(hn::LoadU(tag, before - n * kBrickX), hn::LoadU(tag, after + n * kBrickX));
    best = hn::Min(best, hn::Add(nearer, square));
  }
}

// The rows of one layer of a stack along y, with a row of background before and after.
struct LayerRows {
  explicit LayerRows(size_t bricks)
      : own((4 * bricks + 2) * kBrickX), between((4 * bricks + 2) * kBrickX) {}
  std::vector<float> own;
  std::vector<float> between;
};

HWY_INLINE void ReadLayer(const EuclideanView& view, float unit_square, BrickStack stack, size_t k,
                          const SideRuns<uint32_t>& runs, BrickIndex first, Sublattice sublattice,
                          LayerRows& rows) {
  PointRuns points;
  std::fill_n(rows.between.begin(), kBrickX, unit_square);
  std::fill_n(rows.between.end() - kBrickX, kBrickX, unit_square);
  size_t at = kBrickX;
  for (BrickIndex brick : stack) {
    for (size_t row = 4 * k; row < 4 * k + 4; ++row, at += kBrickX) {
      const uint16_t bits = RowBits(view.object[brick], row);
      if (bits == 0) {
        std::fill_n(rows.own.begin() + static_cast<ptrdiff_t>(at), kBrickX, 0.0f);
        std::fill_n(rows.between.begin() + static_cast<ptrdiff_t>(at), kBrickX, unit_square);
        continue;
      }
      FindPointRuns(bits, runs.left[brick - first][row], runs.right[brick - first][row], points);
      MeasureRow(points, sublattice, unit_square, rows.own.data() + at, rows.between.data() + at);
    }
  }
}

HWY_INLINE void WriteOwnRow(const SquaredLengths& lengths, const float* row, float* to) {
  const Floats tag;
  for (size_t i = 0; i < kBrickX; i += hn::Lanes(tag)) {
    const float* at = row + i;
    const auto best =
        LookOutward<2>(hn::LoadU(tag, at), at - kBrickX, at + kBrickX, lengths.y.data() + 2, 0);
    hn::StoreU(best, tag, to + i);
  }
}

// The places between a row and the next one.
HWY_INLINE void WriteBetween(const SquaredLengths& lengths, const float* row, float* to) {
  const Floats tag;
  for (size_t i = 0; i < kBrickX; i += hn::Lanes(tag)) {
    const float* at = row + i;
    const auto nearest = hn::Min(hn::LoadU(tag, at), hn::LoadU(tag, at + kBrickX));
    const auto best = LookOutward<2>(hn::Add(nearest, hn::Set(tag, lengths.y[1])), at - kBrickX,
                                     at + 2 * kBrickX, lengths.y.data() + 3, lengths.x);
    hn::StoreU(best, tag, to + i);
  }
}

// Where the distances between the points of layer k of a brick go; null if nobody needs them.
HWY_INLINE float* BesideLayer(const EuclideanView& view, BrickIndex brick, Sublattice sublattice,
                              size_t k) {
  const BrickNeighborhood& near = view.neighbors[brick];
  const auto layer = [&](BrickIndex n, size_t which) {
    return view.beside + (size_t{n} * kLayersBeside + which) * kLayerPoints;
  };
  if (near[0] != view.padding) return layer(near[0], k);
  const bool is_outermost = k == (sublattice == Sublattice::kEven ? 0 : kBrickZ - 1);
  return is_outermost && near[4] != view.padding ? layer(near[4], kBrickZ) : nullptr;
}

void ScanLayersTarget(const EuclideanView& view, const SquaredLengths& lengths,
                      Sublattice sublattice, BrickStack stack, const SideRuns<uint32_t>& runs,
                      BrickIndex first) {
  LayerRows rows(stack.size());
  // The place that belongs to a row lies after it for even points, before it for odd ones.
  const size_t back = sublattice == Sublattice::kEven ? 0 : kBrickX;
  for (size_t k = 0; k < kBrickZ; ++k) {
    ReadLayer(view, lengths.x, stack, k, runs, first, sublattice, rows);
    for (size_t n = 0; n < stack.size(); ++n) {
      float* own = view.own + size_t{stack[n]} * kBrickPoints + k * kLayerPoints;
      float* beside = BesideLayer(view, stack[n], sublattice, k);
      for (size_t j = 0; j < kBrickY; ++j) {
        const size_t at = (4 * n + j + 1) * kBrickX;
        WriteOwnRow(lengths, rows.own.data() + at, own + j * kBrickX);
        if (beside == nullptr) continue;
        WriteBetween(lengths, rows.between.data() + at - back, beside + j * kBrickX);
      }
    }
  }
}

// Row j of all layers of a stack along z, those of the other sublattice in between, and background
// below and above.
HWY_INLINE void ReadColumn(const EuclideanView& view, BrickStack stack, Sublattice sublattice,
                           size_t j, std::vector<float>& column) {
  const bool even = sublattice == Sublattice::kEven;
  const auto beside = [&](BrickIndex brick, size_t layer) {
    return view.beside + (size_t{brick} * kLayersBeside + layer) * kLayerPoints + j * kBrickX;
  };
  float* to = column.data() + kBrickX;
  const auto add = [&to](const float* row) { to = std::copy_n(row, kBrickX, to); };
  if (even) add(beside(stack.front(), kBrickZ));
  for (BrickIndex brick : stack) {
    const float* own = view.own + size_t{brick} * kBrickPoints + j * kBrickX;
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

void ScanAcrossLayersTarget(const EuclideanView& view, const SquaredLengths& lengths,
                            Sublattice sublattice, BrickStack stack) {
  const Floats tag;
  std::vector<float> column((2 * kBrickZ * stack.size() + 3) * kBrickX);
  for (size_t j = 0; j < kBrickY; ++j) {
    ReadColumn(view, stack, sublattice, j, column);
    const float* row = column.data() + 2 * kBrickX;
    for (BrickIndex brick : stack) {
      float* own = view.own + size_t{brick} * kBrickPoints + j * kBrickX;
      for (size_t k = 0; k < kBrickZ; ++k, own += kLayerPoints, row += 2 * kBrickX) {
        for (size_t i = 0; i < kBrickX; i += hn::Lanes(tag)) {
          const float* at = row + i;
          hn::StoreU(LookOutward<1>(hn::LoadU(tag, at), at - kBrickX, at + kBrickX,
                                    lengths.z.data() + 1, 0),
                     tag, own + i);
        }
      }
    }
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {
HWY_EXPORT(ScanLayersTarget);
HWY_EXPORT(ScanAcrossLayersTarget);

void ScanLayers(const EuclideanView& view, const SquaredLengths& lengths, Sublattice sublattice,
                BrickStack stack, const SideRuns<uint32_t>& runs, BrickIndex first) {
  HWY_DYNAMIC_DISPATCH(ScanLayersTarget)(view, lengths, sublattice, stack, runs, first);
}
void ScanAcrossLayers(const EuclideanView& view, const SquaredLengths& lengths,
                      Sublattice sublattice, BrickStack stack) {
  HWY_DYNAMIC_DISPATCH(ScanAcrossLayersTarget)(view, lengths, sublattice, stack);
}

}  // namespace bccskel
#endif  // HWY_ONCE
