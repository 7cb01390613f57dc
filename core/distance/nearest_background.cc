#include "core/distance/nearest_background.h"

#include <algorithm>
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

// The position of the highest bit of numbers below 2^16.
HWY_INLINE hn::Vec<Floats> HighestBit(hn::Vec<Words> bits) {
  const Words i32;
  const auto exponent = hn::ShiftRight<23>(hn::BitCast(i32, hn::ConvertTo(Floats(), bits)));
  return hn::ConvertTo(Floats(), hn::Sub(exponent, hn::Set(i32, 127)));
}

// The distance along x from a position to the nearest set bit; `before` are the bits up to the
// position.
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

// The bits of a row up to a position.
HWY_INLINE int32_t BitsBefore(int32_t place) {
  if (place < 0) return 0;
  return place >= 2 * kBrickX - 2 ? 0xffff : (2 << (place >> 1)) - 1;
}

HWY_INLINE int NearestBit(uint32_t row, int32_t place) {
  const auto before = static_cast<uint32_t>(BitsBefore(place));
  const uint32_t low = row & before, high = row & ~before;
  if (low == 0) return std::countr_zero(high);
  const int last = static_cast<int>(std::bit_width(low)) - 1;
  if (high == 0) return last;
  const int first = std::countr_zero(high);
  return place - 2 * last <= 2 * first - place ? last : first;
}

// The squared distances to boxes, lowered by 1e-5 relative, since the sums are rounded differently
// elsewhere: a lower bound.
HWY_INLINE hn::Vec<Floats> SquaresToBoxes(const Boxes& boxes, size_t n, const PointSearch& search) {
  const Floats f32;
  const std::array<int32_t, 3> at = {search.at.x, search.at.y, search.at.z};
  auto sum = hn::Zero(f32);
  for (size_t axis = 0; axis < 3; ++axis) {
    const auto from = hn::Set(f32, static_cast<float>(at[axis]));
    const auto below = hn::Sub(hn::LoadU(f32, boxes.low[axis].data() + n), from);
    const auto above = hn::Sub(from, hn::LoadU(f32, boxes.high[axis].data() + n));
    const auto way = hn::Max(hn::Max(below, above), hn::Zero(f32));
    sum = hn::Add(sum, hn::Mul(hn::Mul(way, way), hn::Set(f32, search.squares[axis])));
  }
  return hn::Mul(sum, hn::Set(f32, 0.99999f));
}

// Bit n: lane n is set.
HWY_INLINE uint32_t BitsOf(hn::Mask<Floats> mask) {
  const Floats f32;
  uint32_t bits = 0;
  hn::StoreMaskBits(f32, mask, reinterpret_cast<uint8_t*>(&bits));
  return bits & ((uint32_t{1} << hn::Lanes(f32)) - 1);
}

// Bit n: lane n is less than the limit.
HWY_INLINE uint32_t LanesBelow(hn::Vec<Floats> values, float limit) {
  return BitsOf(hn::Lt(values, hn::Set(Floats(), limit)));
}

// Searches the boxes [first, last) of the highest level. A box is at least as near as any box in
// it, with rounding, too.
NearBox* FindNearBoxesIn(std::span<const Boxes> levels, size_t first, size_t last,
                         const PointSearch& search, float below, NearBox* found) {
  const Floats f32;
  alignas(64) float squares[16];
  for (size_t n = first; n < last; n += hn::Lanes(f32)) {
    const auto squared = SquaresToBoxes(levels.back(), n, search);
    hn::Store(squared, f32, squares);
    for (uint32_t near = LanesBelow(squared, below); near != 0; near &= near - 1) {
      const size_t lane = static_cast<size_t>(std::countr_zero(near)), box = n + lane;
      if (levels.size() == 1) {
        *found++ = {static_cast<uint32_t>(box), squares[lane]};
      } else {
        found = FindNearBoxesIn(levels.first(levels.size() - 1), box * kBoxGroup,
                                (box + 1) * kBoxGroup, search, below, found);
      }
    }
  }
  return found;
}

size_t FindNearBoxesTarget(std::span<const Boxes> levels, const PointSearch& search, float below,
                           NearBox* found) {
  return static_cast<size_t>(
      FindNearBoxesIn(levels, 0, levels.back().size(), search, below, found) - found);
}

// The position of a point relative to a brick.
struct SeenFrom {
  int32_t place;  // along x, from the brick's first cell, in lattice coordinates
  const float* squared_y;
  const float* squared_z;
};

// The squares of the distances to the background of rows n, n + 1, ...
HWY_INLINE hn::Vec<Floats> SquaresOfRows(const SeenFrom& seen, float square_x,
                                         const BrickBits& object, size_t n) {
  const Floats f32;
  const Words i32;
  const hn::Rebind<uint16_t, Floats> u16;
  const auto* rows = reinterpret_cast<const uint16_t*>(object.words.data());
  const auto background =
      hn::Xor(hn::PromoteTo(i32, hn::LoadU(u16, rows + n)), hn::Set(i32, 0xffff));
  const auto x = ToNearestBit(background, hn::Set(i32, BitsBefore(seen.place)),
                              hn::Set(f32, static_cast<float>(seen.place)));
  const auto squared_x = hn::Mul(hn::Mul(x, x), hn::Set(f32, square_x));
  // The number of a row is 4k + j: j repeats every 128 bits or, one lane at a time, is n modulo 4.
  return hn::Add(hn::Add(squared_x, hn::LoadDup128(f32, seen.squared_y + n % kBrickY)),
                 hn::LoadU(f32, seen.squared_z + n));
}

constexpr size_t kRows = kBrickPoints / kBrickX;

HWY_NOINLINE void TakeNearest(const SeenFrom& seen, const float* squares, float least,
                              const BrickBits& object, LatticePoint low, NearestPoint& nearest) {
  const Floats f32;
  size_t first = 0;
  uint32_t lanes;
  while ((lanes = BitsOf(hn::Eq(hn::Load(f32, squares + first), hn::Set(f32, least)))) == 0) {
    first += hn::Lanes(f32);
  }
  const size_t row = first + static_cast<size_t>(std::countr_zero(lanes));
  const auto bits = static_cast<uint32_t>(~object.words[row >> 2] >> (16 * (row & 3)) & 0xffff);
  const auto j = static_cast<int32_t>(row & 3), k = static_cast<int32_t>(row >> 2);
  nearest = {low + LatticePoint{2 * NearestBit(bits, seen.place), 2 * j, 2 * k}, least};
}

HWY_INLINE void SearchBrick(const SeenFrom& seen, float square_x, const BrickBits& object,
                            LatticePoint low, NearestPoint& nearest) {
  const Floats f32;
  alignas(64) float squares[kRows];
  auto least = hn::Set(f32, std::numeric_limits<float>::infinity());
  for (size_t n = 0; n < kRows; n += hn::Lanes(f32)) {
    const auto squared = SquaresOfRows(seen, square_x, object, n);
    hn::Store(squared, f32, squares + n);
    least = hn::Min(least, squared);
  }
  if (hn::AllFalse(f32, hn::Lt(least, hn::Set(f32, nearest.squared)))) return;
  TakeNearest(seen, squares, hn::GetLane(hn::MinOfLanes(f32, least)), object, low, nearest);
}

HWY_INLINE SeenFrom Seen(const BorderBricks::Place& place, const PointSearch& search) {
  return {search.at.x - place.low.x, search.y.From(place.low.y - search.at.y),
          search.z.From(place.low.z - search.at.z)};
}

void FindNearestTarget(std::span<const BorderBricks::Place> places, const Boxes& boxes,
                       size_t group, std::span<const BrickBits> object, const PointSearch& search,
                       NearestPoint& nearest) {
  const Floats f32;
  alignas(64) float squares[16];
  for (size_t n = group * kBoxGroup; n < (group + 1) * kBoxGroup; n += hn::Lanes(f32)) {
    const auto squared = SquaresToBoxes(boxes, n, search);
    hn::Store(squared, f32, squares);
    for (uint32_t near = LanesBelow(squared, nearest.squared); near != 0; near &= near - 1) {
      const auto lane = static_cast<size_t>(std::countr_zero(near));
      if (squares[lane] >= nearest.squared) continue;
      const BorderBricks::Place& place = places[n + lane];
      SearchBrick(Seen(place, search), search.squares[0], object[place.index], place.low, nearest);
    }
  }
}

constexpr float kJustMore = 1.000001f;

// Whether the brick has background nearer than `below`, which is then lowered.
HWY_INLINE bool TakePlace(const BorderBricks::Place& place, size_t number,
                          std::span<const BrickBits> object, const PointSearch& search,
                          float& below, NearestInPlace* found) {
  NearestPoint nearest = {{}, below};
  SearchBrick(Seen(place, search), search.squares[0], object[place.index], place.low, nearest);
  if (nearest.squared >= below) return false;
  below = std::min(below, kJustMore * nearest.squared);
  *found = {nearest, number};
  return true;
}

size_t FindAllInGroupTarget(std::span<const BorderBricks::Place> places, const Boxes& boxes,
                            size_t group, std::span<const BrickBits> object,
                            const PointSearch& search, float& below, NearestInPlace* found) {
  const Floats f32;
  size_t count = 0;
  for (size_t n = group * kBoxGroup; n < (group + 1) * kBoxGroup; n += hn::Lanes(f32)) {
    uint32_t near = LanesBelow(SquaresToBoxes(boxes, n, search), below);
    for (; near != 0; near &= near - 1) {
      const size_t place = n + static_cast<size_t>(std::countr_zero(near));
      if (TakePlace(places[place], place, object, search, below, found + count)) ++count;
    }
  }
  return count;
}

size_t FindAllTarget(std::span<const BorderBricks::Place> places, std::span<const BrickBits> object,
                     const PointSearch& search, float below, NearestInPlace* found) {
  size_t count = 0;
  for (size_t n = 0; n < places.size(); ++n) {
    if (TakePlace(places[n], n, object, search, below, found + count)) ++count;
  }
  return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(FindNearBoxesTarget);
HWY_EXPORT(FindNearestTarget);
HWY_EXPORT(FindAllInGroupTarget);
HWY_EXPORT(FindAllTarget);

size_t FindNearBoxes(std::span<const Boxes> levels, const PointSearch& search, float below,
                     NearBox* found) {
  return HWY_DYNAMIC_DISPATCH(FindNearBoxesTarget)(levels, search, below, found);
}

void FindNearestBackground(std::span<const BorderBricks::Place> places, const Boxes& boxes,
                           size_t group, std::span<const BrickBits> object,
                           const PointSearch& search, NearestPoint& nearest) {
  HWY_DYNAMIC_DISPATCH(FindNearestTarget)(places, boxes, group, object, search, nearest);
}

size_t FindAllNearest(std::span<const BorderBricks::Place> places, const Boxes& boxes, size_t group,
                      std::span<const BrickBits> object, const PointSearch& search, float& below,
                      NearestInPlace* found) {
  return HWY_DYNAMIC_DISPATCH(FindAllInGroupTarget)(places, boxes, group, object, search, below,
                                                    found);
}

size_t FindAllNearest(std::span<const BorderBricks::Place> places,
                      std::span<const BrickBits> object, const PointSearch& search, float below,
                      NearestInPlace* found) {
  return HWY_DYNAMIC_DISPATCH(FindAllTarget)(places, object, search, below, found);
}

}  // namespace bccskel
#endif  // HWY_ONCE
