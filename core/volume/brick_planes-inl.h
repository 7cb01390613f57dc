// The neighbor planes of a brick in vector registers, for kernels that are compiled once per
// instruction set. Include it inside a Highway foreach_target source.
//
// A plane is the 512 bits of a brick in which bit p is set if the neighbor of p in one direction
// is an object point. In the numbering of bricks (core/volume/brick.h) the D8 neighbors of an even
// cell (i, j, k) are the odd cells (i or i-1, j or j-1, k or k-1), those of an odd cell the even
// cells (i or i+1, ...). So a D8 plane is the other sublattice's brick, moved one cell along a set
// of axes S (bit 0 = x, bit 1 = y, bit 2 = z), down or up depending on the sublattice alone; and
// the set of -d is the complement of the set of d. A D6 plane is the brick itself, moved.

#include <bit>

#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"
#include "hwy/highway.h"

#if defined(BCCSKEL_CORE_VOLUME_BRICK_PLANES_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef BCCSKEL_CORE_VOLUME_BRICK_PLANES_INL_H_
#undef BCCSKEL_CORE_VOLUME_BRICK_PLANES_INL_H_
#else
#define BCCSKEL_CORE_VOLUME_BRICK_PLANES_INL_H_
#endif

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using BrickTag = hn::CappedTag<uint64_t, 8>;
using BrickLane = hn::Vec<BrickTag>;
inline constexpr size_t kLanesPerVector = HWY_LANES(uint64_t) < 8 ? HWY_LANES(uint64_t) : 8;
inline constexpr size_t kVectors = 8 / kLanesPerVector;

// A brick in registers: word k of the brick is lane k % kLanesPerVector of vector k /
// kLanesPerVector.
struct Plane {
  BrickLane v[kVectors];
};

HWY_INLINE Plane LoadPlane(const BrickBits& brick) {
  const BrickTag tag;
  Plane plane;
  for (size_t n = 0; n < kVectors; ++n) {
    plane.v[n] = hn::Load(tag, brick.words.data() + n * kLanesPerVector);
  }
  return plane;
}
HWY_INLINE void StorePlane(const Plane& plane, BrickBits& brick) {
  const BrickTag tag;
  for (size_t n = 0; n < kVectors; ++n) {
    hn::Store(plane.v[n], tag, brick.words.data() + n * kLanesPerVector);
  }
}

// Every word is `word`.
HWY_INLINE Plane Repeat(uint64_t word) {
  Plane plane;
  for (size_t n = 0; n < kVectors; ++n) plane.v[n] = hn::Set(BrickTag(), word);
  return plane;
}
HWY_INLINE Plane None() { return Repeat(0); }

#define BCCSKEL_PLANE_OPERATOR(name, expression)          \
  HWY_INLINE Plane name(const Plane& a, const Plane& b) { \
    Plane out;                                            \
    for (size_t n = 0; n < kVectors; ++n) {               \
      out.v[n] = expression;                              \
    }                                                     \
    return out;                                           \
  }
BCCSKEL_PLANE_OPERATOR(And, hn::And(a.v[n], b.v[n]))
BCCSKEL_PLANE_OPERATOR(Or, hn::Or(a.v[n], b.v[n]))
BCCSKEL_PLANE_OPERATOR(Xor, hn::Xor(a.v[n], b.v[n]))
BCCSKEL_PLANE_OPERATOR(AndNot, hn::AndNot(a.v[n], b.v[n]))  // (not a) and b
#undef BCCSKEL_PLANE_OPERATOR

HWY_INLINE bool IsEmpty(const Plane& plane) {
  const BrickTag tag;
  BrickLane any = plane.v[0];
  for (size_t n = 1; n < kVectors; ++n) any = hn::Or(any, plane.v[n]);
  return hn::AllTrue(tag, hn::Eq(any, hn::Zero(tag)));
}

// The number of set bits.
HWY_INLINE uint64_t CountBits(const Plane& plane) {
#if HWY_TARGET <= HWY_AVX3_DL
  return static_cast<uint64_t>(_mm512_reduce_add_epi64(_mm512_popcnt_epi64(plane.v[0].raw)));
#else
  BrickBits bits;
  StorePlane(plane, bits);
  uint64_t count = 0;
  for (uint64_t word : bits.words) count += static_cast<uint64_t>(std::popcount(word));
  return count;
#endif
}

// Adds the number of set bits, lane by lane: lanes are added up once, not for every brick.
HWY_INLINE BrickLane PlusBits(BrickLane sum, const Plane& plane) {
  for (size_t n = 0; n < kVectors; ++n) sum = hn::Add(sum, hn::PopulationCount(plane.v[n]));
  return sum;
}
HWY_INLINE uint64_t TotalOf(BrickLane sum) { return hn::GetLane(hn::SumOfLanes(BrickTag(), sum)); }

// The direction of the neighbor plane's cells: kDown takes the cell with the smaller index.
enum class Step : uint8_t { kDown, kUp };

#undef BCCSKEL_HAVE_FUNNEL_SHIFT
#if HWY_TARGET <= HWY_AVX3_DL
#define BCCSKEL_HAVE_FUNNEL_SHIFT 1
#else
#define BCCSKEL_HAVE_FUNNEL_SHIFT 0
#endif

// Bits move within rows of 16; the bit that enters comes from `next`, the neighboring brick.
template <Step step>
HWY_INLINE Plane StepX(const Plane& own, const Plane& next) {
  Plane out;
  for (size_t n = 0; n < kVectors; ++n) {
#if BCCSKEL_HAVE_FUNNEL_SHIFT
    if constexpr (step == Step::kDown) {
      out.v[n] = BrickLane{_mm512_shldi_epi16(own.v[n].raw, next.v[n].raw, 1)};
    } else {
      out.v[n] = BrickLane{_mm512_shrdi_epi16(own.v[n].raw, next.v[n].raw, 1)};
    }
#elif HWY_TARGET == HWY_SCALAR
    constexpr uint64_t kFirst = 0x0001000100010001;  // the first bit of each row
    constexpr uint64_t kLast = kFirst << 15;
    const uint64_t a = own.v[n].raw, b = next.v[n].raw;
    out.v[n] = BrickLane(step == Step::kDown ? (a << 1 & ~kFirst) | (b >> 15 & kFirst)
                                             : (a >> 1 & ~kLast) | (b << 15 & kLast));
#else
    const hn::Repartition<uint16_t, BrickTag> rows;
    const BrickTag tag;
    const auto a = hn::BitCast(rows, own.v[n]);
    const auto b = hn::BitCast(rows, next.v[n]);
    if constexpr (step == Step::kDown) {
      out.v[n] = hn::BitCast(tag, hn::Or(hn::ShiftLeft<1>(a), hn::ShiftRight<15>(b)));
    } else {
      out.v[n] = hn::BitCast(tag, hn::Or(hn::ShiftRight<1>(a), hn::ShiftLeft<15>(b)));
    }
#endif
  }
  return out;
}

// Rows move within words of four rows.
template <Step step>
HWY_INLINE Plane StepY(const Plane& own, const Plane& next) {
  Plane out;
  for (size_t n = 0; n < kVectors; ++n) {
#if BCCSKEL_HAVE_FUNNEL_SHIFT
    if constexpr (step == Step::kDown) {
      out.v[n] = BrickLane{_mm512_shldi_epi64(own.v[n].raw, next.v[n].raw, 16)};
    } else {
      out.v[n] = BrickLane{_mm512_shrdi_epi64(own.v[n].raw, next.v[n].raw, 16)};
    }
#else
    if constexpr (step == Step::kDown) {
      out.v[n] = hn::Or(hn::ShiftLeft<16>(own.v[n]), hn::ShiftRight<48>(next.v[n]));
    } else {
      out.v[n] = hn::Or(hn::ShiftRight<16>(own.v[n]), hn::ShiftLeft<48>(next.v[n]));
    }
#endif
  }
  return out;
}

// [b_last, a_0, a_1, ...]: lanes move up by one.
HWY_INLINE BrickLane LanesFromBelow(BrickLane a, BrickLane b) {
#if HWY_TARGET <= HWY_AVX3
  return BrickLane{_mm512_alignr_epi64(a.raw, b.raw, 7)};
#elif HWY_TARGET == HWY_AVX2
  const BrickTag tag;
  return hn::CombineShiftRightBytes<8>(tag, a, hn::ConcatLowerUpper(tag, a, b));
#elif HWY_TARGET == HWY_SCALAR
  (void)a;
  return b;
#else
  return hn::CombineShiftRightBytes<8>(BrickTag(), a, b);
#endif
}

// [a_1, a_2, ..., b_0]: lanes move down by one.
HWY_INLINE BrickLane LanesFromAbove(BrickLane a, BrickLane b) {
#if HWY_TARGET <= HWY_AVX3
  return BrickLane{_mm512_alignr_epi64(b.raw, a.raw, 1)};
#elif HWY_TARGET == HWY_AVX2
  const BrickTag tag;
  return hn::CombineShiftRightBytes<8>(tag, hn::ConcatLowerUpper(tag, b, a), a);
#elif HWY_TARGET == HWY_SCALAR
  (void)a;
  return b;
#else
  return hn::CombineShiftRightBytes<8>(BrickTag(), b, a);
#endif
}

// Layers move from word to word.
template <Step step>
HWY_INLINE Plane StepZ(const Plane& own, const Plane& next) {
  Plane out;
  for (size_t n = 0; n < kVectors; ++n) {
    if constexpr (step == Step::kDown) {
      out.v[n] = LanesFromBelow(own.v[n], n == 0 ? next.v[kVectors - 1] : own.v[n - 1]);
    } else {
      out.v[n] = LanesFromAbove(own.v[n], n + 1 == kVectors ? next.v[0] : own.v[n + 1]);
    }
  }
  return out;
}

// Reads the planes of one brick. kStep is kDown for even bricks and kUp for odd ones.
template <Step kStep>
struct PlaneReader {
  const BrickBits* bricks;
  const BrickNeighborhood& neighbors;
  size_t stride = 1;  // between bricks, where several planes of a brick are stored together

  HWY_INLINE Plane Brick(size_t position) const {
    return LoadPlane(bricks[neighbors[position] * stride]);
  }

  // The D8 plane moved along the axes in kAxes. Bricks are joined along z first, so that the later
  // steps take their entering bits from bricks that have been moved already.
  template <int kAxes, int kAt = 0>
  HWY_INLINE Plane Diagonal() const {
    if constexpr ((kAxes & 1) != 0) {
      return StepX<kStep>(Diagonal<kAxes & ~1, kAt>(), Diagonal<kAxes & ~1, kAt | 1>());
    } else if constexpr ((kAxes & 2) != 0) {
      return StepY<kStep>(Diagonal<kAxes & ~2, kAt>(), Diagonal<kAxes & ~2, kAt | 2>());
    } else if constexpr ((kAxes & 4) != 0) {
      return StepZ<kStep>(Brick(kAt), Brick(kAt | 4));
    } else {
      return Brick(kAt);
    }
  }

  // All eight at once, sharing the partial moves.
  HWY_INLINE void AllDiagonals(Plane (&planes)[8]) const {
    const Plane b0 = Brick(0), b1 = Brick(1), b2 = Brick(2), b3 = Brick(3);
    FourDiagonals(b0, b1, b2, b3, planes);
    FourDiagonals(StepZ<kStep>(b0, Brick(4)), StepZ<kStep>(b1, Brick(5)),
                  StepZ<kStep>(b2, Brick(6)), StepZ<kStep>(b3, Brick(7)), planes + 4);
  }

  // The D6 plane along kAxis (0 = x, 1 = y, 2 = z); kTo is kUp for the positive direction.
  template <int kAxis, Step kTo>
  HWY_INLINE Plane Axial(const Plane& own) const {
    const Plane next = Brick(8 + 2 * kAxis + (kTo == Step::kUp ? 0 : 1));
    if constexpr (kAxis == 0) return StepX<kTo>(own, next);
    if constexpr (kAxis == 1) return StepY<kTo>(own, next);
    if constexpr (kAxis == 2) return StepZ<kTo>(own, next);
  }

 private:
  static HWY_INLINE void FourDiagonals(const Plane& p0, const Plane& p1, const Plane& p2,
                                       const Plane& p3, Plane* planes) {
    planes[0] = p0;
    planes[1] = StepX<kStep>(p0, p1);
    planes[2] = StepY<kStep>(p0, p2);
    planes[3] = StepY<kStep>(planes[1], StepX<kStep>(p2, p3));
  }
};

// The axes along which the D8 plane of direction bit `d` is moved.
constexpr int AxesOf(Sublattice sublattice, int d) {
  return sublattice == Sublattice::kEven ? 7 - d : d;
}

// All 14 planes of a brick in the bit order of kDirections14.
template <Sublattice kSublattice>
HWY_INLINE void AllPlanes(const BrickBits* bricks, const BrickNeighborhood& neighbors,
                          const Plane& own, Plane (&planes)[14], size_t stride = 1) {
  const PlaneReader<kSublattice == Sublattice::kEven ? Step::kDown : Step::kUp> read{
      bricks, neighbors, stride};
  Plane diagonals[8];
  read.AllDiagonals(diagonals);
  for (int d = 0; d < 8; ++d) planes[d] = diagonals[AxesOf(kSublattice, d)];
  planes[8] = read.template Axial<0, Step::kUp>(own);
  planes[9] = read.template Axial<0, Step::kDown>(own);
  planes[10] = read.template Axial<1, Step::kUp>(own);
  planes[11] = read.template Axial<1, Step::kDown>(own);
  planes[12] = read.template Axial<2, Step::kUp>(own);
  planes[13] = read.template Axial<2, Step::kDown>(own);
}
HWY_INLINE void AllPlanes(Sublattice sublattice, const BrickBits* bricks,
                          const BrickNeighborhood& neighbors, const Plane& own,
                          Plane (&planes)[14]) {
  if (sublattice == Sublattice::kEven) {
    AllPlanes<Sublattice::kEven>(bricks, neighbors, own, planes);
  } else {
    AllPlanes<Sublattice::kOdd>(bricks, neighbors, own, planes);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
