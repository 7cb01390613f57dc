#include "core/distance/nearest_background.h"

#include <bit>
#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/distance/nearest_background.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
#include "hwy/foreach_target.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Floats = hn::CappedTag<float, 16>;
using Words = hn::RebindToSigned<Floats>;

// The place of the highest bit of numbers below 2^16.
HWY_INLINE hn::Vec<Floats> HighestBit(hn::Vec<Words> bits) {
  const Words i32;
  const auto exponent = hn::ShiftRight<23>(hn::BitCast(i32, hn::ConvertTo(Floats(), bits)));
  return hn::ConvertTo(Floats(), hn::Sub(exponent, hn::Set(i32, 127)));
}

// Along x, from a place to the nearest set bit; `before` are the bits up to the place.
HWY_INLINE hn::Vec<Floats> ToNearestBit(hn::Vec<Words> row, hn::Vec<Words> before,
                                        hn::Vec<Floats> place) {
  const Floats f32;
  const auto far = hn::Set(f32, std::numeric_limits<float>::infinity());
  const auto none = hn::Zero(Words());
  const auto low = hn::And(row, before), high = hn::AndNot(before, row);
  const auto last = HighestBit(low), first = HighestBit(hn::And(high, hn::Neg(high)));
  const auto left = hn::Sub(place, hn::Add(last, last));
  const auto right = hn::Sub(hn::Add(first, first), place);
  return hn::Min(hn::IfThenElse(hn::RebindMask(f32, hn::Eq(low, none)), far, left),
                 hn::IfThenElse(hn::RebindMask(f32, hn::Eq(high, none)), far, right));
}

// The bits of a row up to a place.
HWY_INLINE int32_t BitsBefore(int32_t place) {
  if (place < 0) return 0;
  return place >= 2 * kBrickX - 2 ? 0xffff : (2 << (place >> 1)) - 1;
}

HWY_INLINE int NearestBit(uint32_t row, int32_t place) {
  const auto before = static_cast<uint32_t>(BitsBefore(place));
  const uint32_t low = row & before, high = row & ~before;
  if (low == 0) return std::countr_zero(high);
  const int last = std::bit_width(low) - 1;
  if (high == 0) return last;
  const int first = std::countr_zero(high);
  return place - 2 * last <= 2 * first - place ? last : first;
}

NearestCell FindNearestTarget(const RowSearch& search, const BrickBits& object) {
  constexpr size_t kRows = kBrickPoints / kBrickX;
  const Floats f32;
  const Words i32;
  const hn::Rebind<uint16_t, Floats> u16;
  const auto* rows = reinterpret_cast<const uint16_t*>(object.words.data());
  const auto before = hn::Set(i32, BitsBefore(search.place)), all = hn::Set(i32, 0xffff);
  const auto place = hn::Set(f32, static_cast<float>(search.place));
  const auto square_x = hn::Set(f32, search.square_x);
  alignas(64) float squares[kRows];
  auto least = hn::Set(f32, std::numeric_limits<float>::infinity());
  for (size_t n = 0; n < kRows; n += hn::Lanes(f32)) {
    const auto background = hn::Xor(hn::PromoteTo(i32, hn::LoadU(u16, rows + n)), all);
    const auto x = ToNearestBit(background, before, place);
    const auto squared_x = hn::Mul(hn::Mul(x, x), square_x);
    const auto squared = hn::Add(hn::Add(squared_x, hn::LoadU(f32, search.squared_y + n)),
                                 hn::LoadU(f32, search.squared_z + n));
    hn::Store(squared, f32, squares + n);
    least = hn::Min(least, squared);
  }
  NearestCell nearest = {hn::GetLane(hn::MinOfLanes(f32, least)), 0};
  if (nearest.squared >= search.below) return nearest;
  size_t row = 0;
  while (squares[row] != nearest.squared) ++row;
  const auto bits = static_cast<uint32_t>(~object.words[row >> 2] >> (16 * (row & 3)) & 0xffff);
  nearest.bit = static_cast<int>(16 * row) + NearestBit(bits, search.place);
  return nearest;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindNearestTarget);

NearestCell FindNearestBackground(const RowSearch& search, const BrickBits& object) {
  return HWY_DYNAMIC_DISPATCH(FindNearestTarget)(search, object);
}

}  // namespace bccskel
#endif  // HWY_ONCE
