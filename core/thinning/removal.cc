#include "core/thinning/removal.h"

#include <array>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/thinning/removal.cc"
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

// Whether the neighbor p + offset of a point p may be stored in the brick at `position` of a
// BrickNeighborhood.
constexpr bool LeadsTo(Sublattice sublattice, int position, int direction) {
  if (position >= 8 || direction >= 8) return position == direction;
  // Steps along an axis towards the sublattice's side may leave the brick, the others cannot.
  const int toward = sublattice == Sublattice::kEven ? 7 - direction : direction;
  return (position & ~toward) == 0;
}

// The bits that a removal can make dirty in the brick at each position. Removing r can make p
// removable along d only if d.(r - p) < 0: either r is p - d, or r was the left side of an
// implication.
constexpr std::array<std::array<DirtyMask, 14>, 2> kWakes = [] {
  std::array<std::array<DirtyMask, 14>, 2> wakes = {};
  for (size_t sublattice = 0; sublattice < 2; ++sublattice) {
    for (int position = 0; position < 14; ++position) {
      DirtyMask& wake = wakes[sublattice][static_cast<size_t>(position)];
      wake = kEndPointsDirty;
      for (int n = 0; n < kNeighborCount; ++n) {
        if (!LeadsTo(static_cast<Sublattice>(sublattice), position, n)) continue;
        for (int d = 0; d < 8; ++d) {
          // p = r + offset, so r - p = -offset.
          if (Dot(Direction(d).offset(), Direction(n).offset()) > 0) {
            wake = static_cast<DirtyMask>(wake | 1u << d);
          }
        }
      }
    }
  }
  return wakes;
}();

// The sides of a brick that removed points touch: bits 0 to 2 the low sides along x, y and z, bits
// 3 to 5 the high ones.
using Sides = uint32_t;

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

// The bits that a removal makes dirty in the bricks around, by sublattice and sides. A table, so
// that the loop over the neighbors has no branch that could be mispredicted.
using WakeRow = std::array<DirtyMask, 14>;
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

HWY_INLINE Sides SidesOf(const BrickBits& removed) {
  uint64_t any = 0;
  for (uint64_t word : removed.words) any |= word;
  const auto bit = [](uint64_t bits, int place) {
    return static_cast<Sides>(bits != 0 ? 1 : 0) << place;
  };
  return bit(any & 0x0001000100010001, 0) | bit(any & 0xffff, 1) | bit(removed.words[0], 2) |
         bit(any & 0x8000800080008000, 3) | bit(any >> 48, 4) | bit(removed.words[7], 5);
}

// Removes the points from the brick and makes it dirty. Most bricks run out of candidates before
// the next shell opens; visiting them again would be two thirds of all pre-tests.
HWY_INLINE void RemoveFromBrick(const RemovalView& view, const MarkedBrick& m) {
  const Plane left_over = AndNot(LoadPlane(m.marks), LoadPlane(view.object[m.brick]));
  StorePlane(left_over, view.object[m.brick]);
  const bool done = IsEmpty(And(left_over, LoadPlane(view.candidates[m.brick])));
  constexpr DirtyMask kKind = kOddBrick | kBorderBrick | kBesideSleeper;
  const auto stays = static_cast<DirtyMask>(done ? 0 : 0xffff);
  const auto enabled = static_cast<DirtyMask>(view.enabled[m.brick] & stays);
  view.enabled[m.brick] = enabled;
  DirtyMask& dirty = view.dirty.bricks[m.brick];
  dirty = static_cast<DirtyMask>((dirty & (kKind | stays)) | enabled);
  view.changed[m.brick] = view.cycle;
}

template <Company kCompany>
HWY_INLINE void MarkDirtyAround(const RemovalView& view, BrickIndex brick, const WakeRow& wakes) {
  const BrickNeighborhood& neighbors = view.neighbors[brick];
  for (size_t position = 0; position < wakes.size(); ++position) {
    BrickIndex n = neighbors[position];
    // The padding brick belongs to nobody, so several workers must not write to it.
    if (kCompany == Company::kOthers && n == view.none) n = brick;
    view.dirty.Add<kCompany>(n, view.enabled[n] & wakes[position]);
  }
}

// The same for a brick that borders on other workers' bricks.
HWY_NOINLINE void MarkDirtyAcrossBorder(const RemovalView& view, BrickIndex brick,
                                        const WakeRow& wakes, BricksByOwner& elsewhere) {
  for (size_t position = 0; position < wakes.size(); ++position) {
    const BrickIndex n = view.neighbors[brick][position];
    if (wakes[position] == 0 || n == view.none) continue;
    if (n >= view.first && n < view.last) {
      view.dirty.Add<Company::kOthers>(n, view.enabled[n] & wakes[position]);
    } else {
      elsewhere[view.owners[n / kDirtyGroup]].push_back(n);
    }
  }
}

template <Company kCompany>
uint64_t RemoveAll(const RemovalView view, std::span<const MarkedBrick> marked,
                   BricksByOwner& elsewhere) {
  BrickLane removed = hn::Zero(BrickTag());
  for (const MarkedBrick& m : marked) {
    removed = PlusBits(removed, LoadPlane(m.marks));
    const DirtyMask kind = view.dirty.bricks[m.brick];
    RemoveFromBrick(view, m);
    if ((kind & kBesideSleeper) == 0) continue;
    const WakeRow& wakes = kWakeRows[kind >> 15][SidesOf(m.marks)];
    if ((kind & kBorderBrick) == 0) {
      MarkDirtyAround<kCompany>(view, m.brick, wakes);
    } else {
      MarkDirtyAcrossBorder(view, m.brick, wakes, elsewhere);
    }
  }
  return TotalOf(removed);
}

uint64_t RemoveMarkedTarget(const RemovalView& view, std::span<const MarkedBrick> marked,
                            BricksByOwner& elsewhere) {
  return view.first == 0 && view.last == view.none
             ? RemoveAll<Company::kAlone>(view, marked, elsewhere)
             : RemoveAll<Company::kOthers>(view, marked, elsewhere);
}

}  // namespace HWY_NAMESPACE
}  // namespace bccskel
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace bccskel {

HWY_EXPORT(RemoveMarkedTarget);

uint64_t RemoveMarked(const RemovalView& view, std::span<const MarkedBrick> marked,
                      BricksByOwner& elsewhere) {
  return HWY_DYNAMIC_DISPATCH(RemoveMarkedTarget)(view, marked, elsewhere);
}

}  // namespace bccskel
#endif  // HWY_ONCE
