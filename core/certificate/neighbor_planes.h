#ifndef BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_
#define BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_

#include <cstddef>
#include <cstdint>

#include "core/lattice/directions.h"
#include "core/volume/brick.h"

// Neighbor planes: for a brick and a direction, the 512 bits that say whether each point's neighbor
// in that direction is in the object. With them a test of a neighborhood is a few logic operations
// per 512 points.
//
//   x step: shift within 16-bit lanes      y step: shift by one lane      z step: the next word
//
// What leaves a brick comes from the neighboring brick. D6 neighbors are on the same sublattice,
// one cell away. D8 neighbors are on the other one, half a cell away: an even point's neighbor
// along + has the point's own cell index and along - the index before; an odd point's along - has
// its own index and along + the index after.

namespace bccskel {

enum class Axis : uint8_t { kX, kY, kZ };

namespace planes_internal {
inline constexpr uint64_t kFirstOfLane = 0x0001000100010001;
inline constexpr uint64_t kLastOfLane = 0x8000800080008000;
}  // namespace planes_internal

// Bit c of the result is the bit of the cell after c along the axis; `beyond` is the next brick.
template <Axis axis>
BrickBits TakeNext(const BrickBits& brick, const BrickBits& beyond) {
  BrickBits taken;
  for (size_t k = 0; k < 8; ++k) {
    if constexpr (axis == Axis::kX) {
      taken.words[k] = ((brick.words[k] >> 1) & ~planes_internal::kLastOfLane) |
                       ((beyond.words[k] << 15) & planes_internal::kLastOfLane);
    } else if constexpr (axis == Axis::kY) {
      taken.words[k] = brick.words[k] >> 16 | beyond.words[k] << 48;
    } else {
      taken.words[k] = k < 7 ? brick.words[k + 1] : beyond.words[0];
    }
  }
  return taken;
}

// Bit c of the result is the bit of the cell before c along the axis; `beyond` is the brick before.
template <Axis axis>
BrickBits TakePrevious(const BrickBits& brick, const BrickBits& beyond) {
  BrickBits taken;
  for (size_t k = 0; k < 8; ++k) {
    if constexpr (axis == Axis::kX) {
      taken.words[k] = ((brick.words[k] << 1) & ~planes_internal::kFirstOfLane) |
                       ((beyond.words[k] >> 15) & planes_internal::kFirstOfLane);
    } else if constexpr (axis == Axis::kY) {
      taken.words[k] = brick.words[k] << 16 | beyond.words[k] >> 48;
    } else {
      taken.words[k] = k > 0 ? brick.words[k - 1] : beyond.words[7];
    }
  }
  return taken;
}

// The axes along which the D8 neighbor in direction `d` has another cell index than the point: bit
// 0 for x, 1 for y, 2 for z. Such an index is one less for even points and one more for odd points.
constexpr int SteppedAxes(Sublattice sublattice, Direction d) {
  return sublattice == Sublattice::kEven ? ~d.bit() & 7 : d.bit();
}

namespace planes_internal {

template <Axis axis>
BrickBits TakeStep(Sublattice sublattice, const BrickBits& brick, const BrickBits& beyond) {
  return sublattice == Sublattice::kEven ? TakePrevious<axis>(brick, beyond)
                                         : TakeNext<axis>(brick, beyond);
}

template <Axis axis, typename BrickAt>
BrickBits DiagonalPlane(Sublattice sublattice, int stepped, int position, BrickAt brick_at) {
  constexpr int kBit = 1 << static_cast<int>(axis);
  const auto plane_at = [&](int at) {
    if constexpr (axis == Axis::kX) {
      return brick_at(at);
    } else {
      constexpr Axis kInner = axis == Axis::kZ ? Axis::kY : Axis::kX;
      return DiagonalPlane<kInner>(sublattice, stepped, at, brick_at);
    }
  };
  if ((stepped & kBit) == 0) return plane_at(position);
  return TakeStep<axis>(sublattice, plane_at(position), plane_at(position | kBit));
}

}  // namespace planes_internal

// The plane of direction `d` for a brick with the bits `self`.
// Needs: brick_at(position) gives the BrickBits of the neighboring brick at that position of
//        BrickNeighborhood; only the positions that the direction touches are asked for.
template <typename BrickAt>
BrickBits NeighborPlane(Direction d, Sublattice sublattice, const BrickBits& self,
                        BrickAt brick_at) {
  switch (d.bit()) {
    case 8:
      return TakeNext<Axis::kX>(self, brick_at(8));
    case 9:
      return TakePrevious<Axis::kX>(self, brick_at(9));
    case 10:
      return TakeNext<Axis::kY>(self, brick_at(10));
    case 11:
      return TakePrevious<Axis::kY>(self, brick_at(11));
    case 12:
      return TakeNext<Axis::kZ>(self, brick_at(12));
    case 13:
      return TakePrevious<Axis::kZ>(self, brick_at(13));
    default:
      return planes_internal::DiagonalPlane<Axis::kZ>(sublattice, SteppedAxes(sublattice, d), 0,
                                                      brick_at);
  }
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_
