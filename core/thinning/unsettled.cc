#include "core/thinning/unsettled.h"

#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/unsettled.cc"
// Compiles the rest of this file once per instruction set, so it comes before other Highway
// headers.
// clang-format off
#include "hwy/foreach_target.h"
#include "core/volume/brick_planes-inl.h"
#include "hwy/highway.h"
// clang-format on

#ifndef BCCSKEL_CORE_THINNING_WAKE_TABLES_
#define BCCSKEL_CORE_THINNING_WAKE_TABLES_
namespace bccskel {
namespace {

// For a set of axes, all its subsets: bit s of the result stands for the subset s.
constexpr std::array<uint32_t, 8> kSubsetsOf = [] {
  std::array<uint32_t, 8> subsets = {};
  for (uint32_t axes = 0; axes < 8; ++axes) {
    for (uint32_t s = 0; s < 8; ++s) {
      if ((s & ~axes) == 0) subsets[axes] |= 1u << s;
    }
  }
  return subsets;
}();

// The position in a BrickNeighborhood at which the neighbor p + offset of a point p may be stored,
// if it is not in the brick that `position` names: whether the offset can lead there.
constexpr bool LeadsTo(Sublattice sublattice, int position, int direction) {
  if (position >= 8 || direction >= 8) return position == direction;
  // Steps along an axis towards the sublattice's side may leave the brick, the others cannot.
  const int toward = sublattice == Sublattice::kEven ? 7 - direction : direction;
  return (position & ~toward) == 0;
}

// What a removal can unsettle in the brick at each position. Removing r can make p removable along
// d only if d.(r - p) < 0: either r is p - d, or it stood on the left of an implication.
constexpr std::array<std::array<Unsettled, 14>, 2> kWakes = [] {
  std::array<std::array<Unsettled, 14>, 2> wakes = {};
  for (size_t sublattice = 0; sublattice < 2; ++sublattice) {
    for (int position = 0; position < 14; ++position) {
      Unsettled& wake = wakes[sublattice][static_cast<size_t>(position)];
      wake = kEndPointsUnsettled;
      for (int n = 0; n < kNeighborCount; ++n) {
        if (!LeadsTo(static_cast<Sublattice>(sublattice), position, n)) continue;
        for (int d = 0; d < 8; ++d) {
          // p = r + offset, so r - p = -offset.
          if (Dot(Direction(d).offset(), Direction(n).offset()) > 0) {
            wake = static_cast<Unsettled>(wake | 1u << d);
          }
        }
      }
    }
  }
  return wakes;
}();

}  // namespace
}  // namespace bccskel
#endif  // tables

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

// Bit n of each: what lane n of a group says.
struct GroupBits {
  uint32_t along_d = 0;
  uint32_t end_points = 0;
  uint32_t odd = 0;
};

HWY_INLINE GroupBits TakeGroup(Unsettled* group, Unsettled along_d) {
  GroupBits bits;
#if HWY_TARGET == HWY_SCALAR
  for (size_t n = 0; n < kUnsettledGroup; ++n) {
    bits.along_d |= ((group[n] & along_d) != 0 ? 1u : 0u) << n;
    bits.end_points |= ((group[n] & kEndPointsUnsettled) != 0 ? 1u : 0u) << n;
    bits.odd |= (group[n] >> 15 & 1u) << n;
    group[n] = static_cast<Unsettled>(group[n] & ~(along_d | kEndPointsUnsettled));
  }
#else
  const hn::CappedTag<uint16_t, kUnsettledGroup> tag;
  const auto d = hn::Set(tag, along_d), ends = hn::Set(tag, kEndPointsUnsettled);
  const auto odd = hn::Set(tag, kOddBrick);
  for (size_t n = 0; n < kUnsettledGroup; n += hn::Lanes(tag)) {
    const auto lanes = hn::LoadU(tag, group + n);
    hn::StoreMaskBits(tag, hn::TestBit(lanes, d),
                      reinterpret_cast<uint8_t*>(&bits.along_d) + n / 8);
    hn::StoreMaskBits(tag, hn::TestBit(lanes, ends),
                      reinterpret_cast<uint8_t*>(&bits.end_points) + n / 8);
    hn::StoreMaskBits(tag, hn::TestBit(lanes, odd), reinterpret_cast<uint8_t*>(&bits.odd) + n / 8);
    hn::StoreU(hn::AndNot(hn::Or(d, ends), lanes), tag, group + n);
  }
#endif
  return bits;
}

HWY_INLINE size_t Append(uint32_t bits, size_t first, BrickIndex* list, size_t count) {
  for (; bits != 0; bits &= bits - 1) {
    list[count++] = static_cast<BrickIndex>(first + static_cast<size_t>(std::countr_zero(bits)));
  }
  return count;
}

void TakeUnsettledTarget(std::span<Unsettled> unsettled, size_t first, size_t last,
                         Unsettled along_d, BrickLists& lists, BrickLists& end_lists) {
  const std::array<BrickIndex*, 2> list = lists.storage(), end_list = end_lists.storage();
  size_t count[2] = {0, 0}, ends[2] = {0, 0};
  for (size_t at = first; at < last; at += kUnsettledGroup) {
    const GroupBits bits = TakeGroup(unsettled.data() + at, along_d);
    if ((bits.along_d | bits.end_points) == 0) continue;
    count[0] = Append(bits.along_d & ~bits.odd, at, list[0], count[0]);
    count[1] = Append(bits.along_d & bits.odd, at, list[1], count[1]);
    ends[0] = Append(bits.end_points & ~bits.odd, at, end_list[0], ends[0]);
    ends[1] = Append(bits.end_points & bits.odd, at, end_list[1], ends[1]);
  }
  for (size_t s = 0; s < 2; ++s) {
    lists.SetCount(s, count[s]);
    end_lists.SetCount(s, ends[s]);
  }
}

// The neighboring bricks (positions of BrickNeighborhood) that hold neighbors of removed points.
HWY_INLINE uint32_t BricksThatSee(const BrickBits& removed, bool odd) {
  uint64_t any = 0;
  for (uint64_t word : removed.words) any |= word;
  const uint32_t low = ((any & 0x0001000100010001) != 0 ? 1u : 0u) |
                       ((any & 0xffff) != 0 ? 2u : 0u) | (removed.words[0] != 0 ? 4u : 0u);
  const uint32_t high = ((any & 0x8000800080008000) != 0 ? 1u : 0u) | ((any >> 48) != 0 ? 2u : 0u) |
                        (removed.words[7] != 0 ? 4u : 0u);
  const uint32_t axial = (high & 1) << 8 | (low & 1) << 9 | (high & 2) << 9 | (low & 2) << 10 |
                         (high & 4) << 10 | (low & 4) << 11;
  return kSubsetsOf[odd ? high : low] | axial;
}

HWY_INLINE uint64_t CountBits(const BrickBits& bits) {
  uint64_t count = 0;
  for (uint64_t word : bits.words) count += static_cast<uint64_t>(std::popcount(word));
  return count;
}

uint64_t RemoveMarkedTarget(const RemovalView& view, std::span<const MarkedBrick> marked,
                            std::vector<BrickIndex>& elsewhere) {
  uint64_t removed = 0;
  for (const MarkedBrick& m : marked) {
    const uint64_t count = CountBits(m.marks);
    if (count == 0) continue;
    removed += count;
    const Plane left_over = AndNot(LoadPlane(m.marks), LoadPlane(view.object[m.brick]));
    StorePlane(left_over, view.object[m.brick]);
    const size_t odd = view.unsettled[m.brick] >> 15;
    // Most bricks run out of candidates before the next shell opens; looking at them again would be
    // two thirds of all pre-tests.
    if (IsEmpty(And(left_over, LoadPlane(view.candidates[m.brick])))) {
      view.enabled[m.brick] = 0;
      view.unsettled[m.brick] &= kOddBrick;
    } else {
      view.unsettled[m.brick] |= view.enabled[m.brick];
    }
    const BrickNeighborhood& neighbors = view.neighbors[m.brick];
    for (uint32_t left = BricksThatSee(m.marks, odd != 0); left != 0; left &= left - 1) {
      const auto position = static_cast<size_t>(std::countr_zero(left));
      const BrickIndex n = neighbors[position];
      if (n - view.first < view.last - view.first) {
        view.unsettled[n] =
            static_cast<Unsettled>(view.unsettled[n] | (view.enabled[n] & kWakes[odd][position]));
      } else {
        elsewhere.push_back(n);
      }
    }
  }
  return removed;
}

uint64_t OpenShellInBrickTarget(const ShellPlanes& planes, int32_t shell, const BrickBits& object,
                                BrickBits& candidates) {
  Plane opened = LoadPlane(object);
  for (size_t b = 0; b < kShellPlanes; ++b) {
    const Plane plane = LoadPlane(planes[b]);
    opened = (shell >> b & 1) != 0 ? And(plane, opened) : AndNot(plane, opened);
  }
  StorePlane(Or(opened, LoadPlane(candidates)), candidates);
  BrickBits bits;
  StorePlane(opened, bits);
  return CountBits(bits);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(TakeUnsettledTarget);
HWY_EXPORT(RemoveMarkedTarget);
HWY_EXPORT(OpenShellInBrickTarget);

void TakeUnsettled(std::span<Unsettled> unsettled, size_t first, size_t last, DiagonalDirection d,
                   BrickLists& along_d, BrickLists& end_points) {
  HWY_DYNAMIC_DISPATCH(TakeUnsettledTarget)
  (unsettled, first, last, static_cast<Unsettled>(1u << d.bit()), along_d, end_points);
}
uint64_t RemoveMarked(const RemovalView& view, std::span<const MarkedBrick> marked,
                      std::vector<BrickIndex>& elsewhere) {
  return HWY_DYNAMIC_DISPATCH(RemoveMarkedTarget)(view, marked, elsewhere);
}
uint64_t OpenShellInBrick(const ShellPlanes& planes, int32_t shell, const BrickBits& object,
                          BrickBits& candidates) {
  return HWY_DYNAMIC_DISPATCH(OpenShellInBrickTarget)(planes, shell, object, candidates);
}

}  // namespace bccskel
#endif  // HWY_ONCE
