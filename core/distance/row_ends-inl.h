// Distances along a row of points, for kernels that are compiled once per instruction set. Include
// it inside a Highway foreach_target source.

#include <array>
#include <cstdint>

#include "core/volume/brick.h"
#include "hwy/highway.h"

#if defined(BCCSKEL_CORE_DISTANCE_ROW_ENDS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BCCSKEL_CORE_DISTANCE_ROW_ENDS_INL_H_
#undef BCCSKEL_CORE_DISTANCE_ROW_ENDS_INL_H_
#else
#define BCCSKEL_CORE_DISTANCE_ROW_ENDS_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using RunTag = hn::CappedTag<int32_t, kBrickX>;
using Run = hn::Vec<RunTag>;

// The bits 0..i of 16, for i from -1 to 15.
alignas(64) constexpr std::array<int32_t, kBrickX + 1> kBitsUpTo = {
    0x0000, 0x0001, 0x0003, 0x0007, 0x000f, 0x001f, 0x003f, 0x007f, 0x00ff,
    0x01ff, 0x03ff, 0x07ff, 0x0fff, 0x1fff, 0x3fff, 0x7fff, 0xffff};

// The highest bit, or `none` if no bit is set, from the exponent of a float: 16-bit integers are
// exact as floats. Without branches, since rows at a boundary are unpredictable.
HWY_INLINE Run HighestBit(Run bits, int32_t none) {
  const RunTag ints;
  const auto exponent =
      hn::ShiftRight<23>(hn::BitCast(ints, hn::ConvertTo(hn::RebindToFloat<RunTag>(), bits)));
  return hn::IfThenElse(hn::Eq(bits, hn::Zero(ints)), hn::Set(ints, none),
                        hn::Sub(exponent, hn::Set(ints, 127)));
}

// The background of a row, and how many object points continue it on either side.
struct RowEnds {
  int32_t background;  // a bit per point
  int32_t left;
  int32_t right;

  // The number of consecutive object points up to point i, and from point i on.
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

// Squared distances along x to the background of a row: from its points, and from the positions
// between them, which lie to the right of even points and to the left of odd ones.
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

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
