#include "core/thinning/unsettled.h"

#include <algorithm>
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

// Which sides of a brick removed points touch: bits 0 to 2 the low sides along x, y and z, bits 3
// to 5 the high ones.
using Sides = uint32_t;

constexpr Unsettled kSomeToDo = kDirectionsUnsettled | kEndPointsUnsettled | kAwake;

// Whether points at these sides have neighbors in the brick at a position.
constexpr bool Sees(Sublattice sublattice, Sides sides, int position) {
  const Sides low = sides & 7, high = sides >> 3;
  if (position < 8) {
    const Sides toward = sublattice == Sublattice::kEven ? low : high;
    return (static_cast<Sides>(position) & ~toward) == 0;
  }
  const int axis = (position - 8) / 2;
  return ((position % 2 == 0 ? high : low) >> axis & 1) != 0;
}

// What a removal unsettles around it, by sublattice and sides: a table because the loop over the
// neighbors has no other branch that could be mispredicted.
using WakeRow = std::array<Unsettled, 14>;
using WakeRows = std::array<std::array<WakeRow, 64>, 2>;
constexpr WakeRows kWakeRows = [] {
  WakeRows rows = {};
  for (size_t sublattice = 0; sublattice < 2; ++sublattice) {
    for (Sides sides = 0; sides < 64; ++sides) {
      for (int position = 0; position < 14; ++position) {
        const auto at = static_cast<size_t>(position);
        if (!Sees(static_cast<Sublattice>(sublattice), sides, position)) continue;
        rows[sublattice][sides][at] = kWakes[sublattice][at];
      }
    }
  }
  return rows;
}();

}  // namespace
}  // namespace bccskel
#endif  // tables

HWY_BEFORE_NAMESPACE();
namespace bccskel {
namespace HWY_NAMESPACE {

// Bit n of each: what lane n of a group says.
struct GroupBits {
  uint32_t found = 0;
  uint32_t end_points = 0;
  uint32_t odd = 0;
  bool rest = true;  // nothing to do in any pass
};

// Reads a group and settles it.
HWY_INLINE GroupBits TakeGroup(Unsettled* group, Unsettled looked_for) {
  GroupBits bits;
#if HWY_TARGET == HWY_SCALAR
  for (size_t n = 0; n < kUnsettledGroup; ++n) {
    bits.found |= ((group[n] & (looked_for | kAwake)) != 0 ? 1u : 0u) << n;
    bits.end_points |= ((group[n] & kEndPointsUnsettled) != 0 ? 1u : 0u) << n;
    bits.odd |= (group[n] >> 15 & 1u) << n;
    bits.rest = bits.rest && (group[n] & kSomeToDo) == 0;
    group[n] = static_cast<Unsettled>(group[n] & ~(looked_for | kEndPointsUnsettled));
  }
#else
  const hn::CappedTag<Unsettled, kUnsettledGroup> tag;
  const auto any = hn::Set(tag, static_cast<Unsettled>(looked_for | kAwake));
  const auto ends = hn::Set(tag, kEndPointsUnsettled), odd = hn::Set(tag, kOddBrick);
  const auto some = hn::Set(tag, kSomeToDo);
  const auto settled = hn::Set(tag, static_cast<Unsettled>(looked_for | kEndPointsUnsettled));
  const auto zero = hn::Zero(tag);
  for (size_t n = 0; n < kUnsettledGroup; n += hn::Lanes(tag)) {
    const auto lanes = hn::LoadU(tag, group + n);
    if (hn::AllTrue(tag, hn::Eq(hn::And(lanes, some), zero))) continue;
    bits.rest = false;
    const auto store = [&](auto mask, uint32_t& to) HWY_ATTR {
      hn::StoreMaskBits(tag, mask, reinterpret_cast<uint8_t*>(&to) + n / 8);
    };
    store(hn::Ne(hn::And(lanes, any), zero), bits.found);
    store(hn::TestBit(lanes, ends), bits.end_points);
    store(hn::TestBit(lanes, odd), bits.odd);
    hn::StoreU(hn::AndNot(settled, lanes), tag, group + n);
  }
#endif
  return bits;
}

// One list being written.
struct ListWriter {
  BrickIndex* list;
  size_t count = 0;

  // Appends first + n for every set bit n. With AVX-512 whole registers are written and the next
  // ones overwrite their tails; elsewhere compressing costs more than mispredicted loop ends.
  HWY_INLINE void Append(uint32_t bits, size_t first) {
#if HWY_TARGET <= HWY_AVX3
    const hn::CappedTag<uint32_t, 16> tag;
    for (size_t n = 0; n < kUnsettledGroup; n += 16, bits >>= 16) {
      const auto half = static_cast<uint16_t>(bits);
      const auto mask = hn::LoadMaskBits(tag, reinterpret_cast<const uint8_t*>(&half));
      const auto bricks = hn::Iota(tag, static_cast<uint32_t>(first + n));
      hn::StoreU(hn::Compress(bricks, mask), tag, list + count);
      count += static_cast<size_t>(std::popcount(half));
    }
#else
    for (; bits != 0; bits &= bits - 1) {
      list[count++] = static_cast<BrickIndex>(first + static_cast<size_t>(std::countr_zero(bits)));
    }
#endif
  }
};

void TakeUnsettledTarget(const UnsettledBricks& unsettled, size_t first, size_t last,
                         Unsettled looked_for, BrickLists& lists, BrickLists& end_lists) {
  ListWriter even = {lists.storage()[0]}, odd = {lists.storage()[1]};
  ListWriter even_ends = {end_lists.storage()[0]}, odd_ends = {end_lists.storage()[1]};
  for (size_t at = first; at < last; at += kUnsettledGroup) {
    uint8_t& some = unsettled.groups[at / kUnsettledGroup];
    if (some == 0) continue;
    GroupBits bits = TakeGroup(unsettled.bricks + at, looked_for);
    // Bricks that are found may become unsettled again in this pass, so their group does not rest
    // before the next one.
    some = bits.rest ? 0 : 1;
    bits.end_points &= ~bits.found;
    if ((bits.found | bits.end_points) == 0) continue;
    even.Append(bits.found & ~bits.odd, at);
    odd.Append(bits.found & bits.odd, at);
    if (bits.end_points == 0) continue;
    even_ends.Append(bits.end_points & ~bits.odd, at);
    odd_ends.Append(bits.end_points & bits.odd, at);
  }
  lists.SetCounts(even.count, odd.count);
  end_lists.SetCounts(even_ends.count, odd_ends.count);
}

// Adds the number of set bits, lane by lane: lanes are added up once, not for every brick.
HWY_INLINE BrickLane PlusBits(BrickLane sum, const Plane& plane) {
  for (size_t n = 0; n < kVectors; ++n) sum = hn::Add(sum, hn::PopulationCount(plane.v[n]));
  return sum;
}
HWY_INLINE uint64_t TotalOf(BrickLane sum) { return hn::GetLane(hn::SumOfLanes(BrickTag(), sum)); }

HWY_INLINE Sides SidesOf(const BrickBits& removed) {
  uint64_t any = 0;
  for (uint64_t word : removed.words) any |= word;
  const auto bit = [](uint64_t bits, int place) {
    return static_cast<Sides>(bits != 0 ? 1 : 0) << place;
  };
  return bit(any & 0x0001000100010001, 0) | bit(any & 0xffff, 1) | bit(removed.words[0], 2) |
         bit(any & 0x8000800080008000, 3) | bit(any >> 48, 4) | bit(removed.words[7], 5);
}

// Takes the points out of the brick and unsettles it. Most bricks run out of candidates before the
// next shell opens; looking at them again would be two thirds of all pre-tests.
HWY_INLINE void RemoveFromBrick(const RemovalView& view, const MarkedBrick& m) {
  const Plane left_over = AndNot(LoadPlane(m.marks), LoadPlane(view.object[m.brick]));
  StorePlane(left_over, view.object[m.brick]);
  const bool done = IsEmpty(And(left_over, LoadPlane(view.candidates[m.brick])));
  constexpr Unsettled kKind = kOddBrick | kBorderBrick | kBesideSleeper;
  const auto stays = static_cast<Unsettled>(done ? 0 : 0xffff);
  const auto enabled = static_cast<Unsettled>(view.enabled[m.brick] & stays);
  view.enabled[m.brick] = enabled;
  Unsettled& unsettled = view.unsettled.bricks[m.brick];
  unsettled = static_cast<Unsettled>((unsettled & (kKind | stays)) | enabled);
  view.changed[m.brick] = view.cycle;
}

// Whether other workers remove points at the same time.
enum class Company : uint8_t { kAlone, kOthers };

template <Company kCompany>
HWY_INLINE void UnsettleAround(const RemovalView& view, BrickIndex brick, const WakeRow& wakes) {
  const BrickNeighborhood& neighbors = view.neighbors[brick];
  for (size_t position = 0; position < wakes.size(); ++position) {
    BrickIndex n = neighbors[position];
    // The padding brick belongs to nobody, so several workers must not write to it.
    if (kCompany == Company::kOthers && n == view.none) n = brick;
    view.unsettled.Add(n, view.enabled[n] & wakes[position]);
  }
}

// The same for a brick that borders on other workers' bricks.
HWY_NOINLINE void UnsettleAcrossBorder(const RemovalView& view, BrickIndex brick,
                                       const WakeRow& wakes, std::vector<BrickIndex>& elsewhere) {
  for (size_t position = 0; position < wakes.size(); ++position) {
    const BrickIndex n = view.neighbors[brick][position];
    if (wakes[position] == 0 || n == view.none) continue;
    if (n >= view.first && n < view.last) {
      view.unsettled.Add(n, view.enabled[n] & wakes[position]);
    } else {
      elsewhere.push_back(n);
    }
  }
}

template <Company kCompany>
uint64_t RemoveAll(const RemovalView view, std::span<const MarkedBrick> marked,
                   std::vector<BrickIndex>& elsewhere) {
  BrickLane removed = hn::Zero(BrickTag());
  for (const MarkedBrick& m : marked) {
    removed = PlusBits(removed, LoadPlane(m.marks));
    const Unsettled kind = view.unsettled.bricks[m.brick];
    RemoveFromBrick(view, m);
    if ((kind & kBesideSleeper) == 0) continue;
    const WakeRow& wakes = kWakeRows[kind >> 15][SidesOf(m.marks)];
    if ((kind & kBorderBrick) == 0) {
      UnsettleAround<kCompany>(view, m.brick, wakes);
    } else {
      UnsettleAcrossBorder(view, m.brick, wakes, elsewhere);
    }
  }
  return TotalOf(removed);
}

uint64_t RemoveMarkedTarget(const RemovalView& view, std::span<const MarkedBrick> marked,
                            std::vector<BrickIndex>& elsewhere) {
  return view.first == 0 && view.last == view.none
             ? RemoveAll<Company::kAlone>(view, marked, elsewhere)
             : RemoveAll<Company::kOthers>(view, marked, elsewhere);
}

// Planes are read from far away, a brick in some place at a time: a processor waits for fewer lines
// at once than it can have under way.
constexpr size_t kAhead = 6;
HWY_INLINE BrickIndex Ahead(std::span<const BrickIndex> bricks, size_t at) {
  return bricks[std::min(at + kAhead, bricks.size() - 1)];
}

HWY_INLINE Plane AllPoints() {
  Plane all;
  for (BrickLane& lane : all.v) lane = hn::Set(BrickTag(), ~uint64_t{0});
  return all;
}

// Those of `points` whose bit in a plane is the lowest of `number`.
HWY_INLINE Plane WithBit(const Plane& points, const BrickBits& plane, int32_t number) {
  const Plane set = LoadPlane(plane);
  return (number & 1) != 0 ? And(set, points) : AndNot(set, points);
}

void CutShellsTarget(std::span<const ShellPlanes> planes, int32_t first,
                     std::span<const BrickIndex> bricks, BrickBits* points) {
  const size_t count = bricks.size();
  for (size_t at = 0; at < count; ++at) {
    for (const BrickBits& plane : planes[Ahead(bricks, at)]) __builtin_prefetch(&plane, 0, 2);
    const ShellPlanes& own = planes[bricks[at]];
    const Plane one = LoadPlane(own[0]), two = LoadPlane(own[1]);
    // The points of these shells, by the bits that the shells share.
    Plane group = WithBit(AllPoints(), own[2], first >> 2);
    for (int b = 3; b < kShellPlanes; ++b) {
      group = WithBit(group, own[static_cast<size_t>(b)], first >> b);
    }
    const Plane low = AndNot(two, group), high = And(two, group);
    StorePlane(AndNot(one, low), points[at]);
    StorePlane(And(one, low), points[count + at]);
    StorePlane(AndNot(one, high), points[2 * count + at]);
    StorePlane(And(one, high), points[3 * count + at]);
  }
}

uint64_t OpenShellTarget(const OpeningView& view, std::span<const BrickIndex> bricks,
                         const BrickBits* points) {
  BrickLane count = hn::Zero(BrickTag());
  for (size_t at = 0; at < bricks.size(); ++at) {
    const BrickIndex n = bricks[at], ahead = Ahead(bricks, at);
    __builtin_prefetch(&view.object[ahead], 0, 2);
    __builtin_prefetch(&view.candidates[ahead], 1, 2);
    Plane opened = And(LoadPlane(points[at]), LoadPlane(view.object[n]));
    if (view.kept != nullptr) opened = AndNot(LoadPlane(view.kept[n]), opened);
    StorePlane(Or(opened, LoadPlane(view.candidates[n])), view.candidates[n]);
    count = PlusBits(count, opened);
    const auto some = static_cast<Unsettled>(IsEmpty(opened) ? 0 : 0xffff);
    view.enabled[n] |= static_cast<Unsettled>(view.watched & some);
    view.unsettled.Add(n, view.woken & some);
  }
  return TotalOf(count);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(TakeUnsettledTarget);
HWY_EXPORT(RemoveMarkedTarget);
HWY_EXPORT(CutShellsTarget);
HWY_EXPORT(OpenShellTarget);

void TakeUnsettled(const UnsettledBricks& unsettled, size_t first, size_t last,
                   Unsettled looked_for, BrickLists& found, BrickLists& end_points) {
  HWY_DYNAMIC_DISPATCH(TakeUnsettledTarget)
  (unsettled, first, last, looked_for, found, end_points);
}
uint64_t RemoveMarked(const RemovalView& view, std::span<const MarkedBrick> marked,
                      std::vector<BrickIndex>& elsewhere) {
  return HWY_DYNAMIC_DISPATCH(RemoveMarkedTarget)(view, marked, elsewhere);
}
void CutShells(std::span<const ShellPlanes> planes, int32_t first,
               std::span<const BrickIndex> bricks, BrickBits* points) {
  HWY_DYNAMIC_DISPATCH(CutShellsTarget)(planes, first, bricks, points);
}
uint64_t OpenShell(const OpeningView& view, std::span<const BrickIndex> bricks,
                   const BrickBits* points) {
  return HWY_DYNAMIC_DISPATCH(OpenShellTarget)(view, bricks, points);
}

}  // namespace bccskel
#endif  // HWY_ONCE
