#ifndef BCCSKEL_CORE_THINNING_WORK_LIST_H_
#define BCCSKEL_CORE_THINNING_WORK_LIST_H_

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/volume/brick.h"

// Which bricks a pass has to visit again.

namespace bccskel {

// State bits of a brick. Bit d: points may have become removable along direction d; bit 8: there
// may be end points. A brick whose shell has just opened is awake: every pass visits it whatever
// these bits are, since nearly all such bricks change and notifying 14 neighbors of each change
// would cost more than a visit. It falls asleep after a cycle in which neither it nor an adjacent
// brick has changed; from then on changes beside it make it dirty. Bit 13: it lies beside a
// sleeping brick and so must notify its neighbors of changes; bit 14: some of these belong to other
// workers; bit 15: it is of the odd sublattice.
using DirtyMask = uint16_t;
inline constexpr DirtyMask kEndPointsDirty = 1 << 8;
inline constexpr DirtyMask kDirectionsDirty = kEndPointsDirty - 1;
inline constexpr DirtyMask kAwake = 1 << 9;
inline constexpr DirtyMask kBesideSleeper = 1 << 13;
inline constexpr DirtyMask kBorderBrick = 1 << 14;
inline constexpr DirtyMask kOddBrick = 1 << 15;

// Ranges of bricks start at multiples of this, and arrays of DirtyMask are padded to one.
inline constexpr size_t kDirtyGroup = 32;

// Whether other workers write to bricks of their own at the same time.
enum class Company : uint8_t { kAlone, kOthers };

// Arrays for all bricks. Copies share them.
struct DirtyBricks {
  DirtyMask* bricks = nullptr;
  // One for each group; 0: all its bricks are settled and asleep, as most are, so passes do not
  // read them.
  uint8_t* groups = nullptr;

  template <Company kCompany = Company::kOthers>
  void Add(BrickIndex brick, DirtyMask bits) const {
    bricks[brick] = static_cast<DirtyMask>(bricks[brick] | bits);
    uint8_t& group = groups[brick / kDirtyGroup];
    // Groups of several workers share a cache line, which each write would take from the others.
    if (kCompany == Company::kAlone || group == 0) group = 1;
  }
};

// The bricks listed for a pass, by sublattice. The storage has the maximum length of the list plus
// a register; it is never cleared, so refilling it costs nothing.
class BrickLists {
 public:
  // Only grows.
  void Reserve(size_t bricks) {
    for (std::vector<BrickIndex>& list : storage_) {
      list.resize(std::max(list.size(), bricks + kDirtyGroup));
    }
  }
  std::span<const BrickIndex> Of(Sublattice sublattice) const {
    const auto s = static_cast<size_t>(sublattice);
    return {storage_[s].data(), count_[s]};
  }
  std::span<BrickIndex> Of(Sublattice sublattice) {
    const auto s = static_cast<size_t>(sublattice);
    return {storage_[s].data(), count_[s]};
  }
  std::array<BrickIndex*, 2> storage() { return {storage_[0].data(), storage_[1].data()}; }
  void SetCounts(size_t even, size_t odd) { count_ = {even, odd}; }

  // Room for the next bricks, some of which Add() then keeps.
  BrickIndex* Room(Sublattice sublattice) {
    const auto s = static_cast<size_t>(sublattice);
    return storage_[s].data() + count_[s];
  }
  void Add(Sublattice sublattice, size_t count) {
    count_[static_cast<size_t>(sublattice)] += count;
  }

 private:
  std::array<std::vector<BrickIndex>, 2> storage_;
  std::array<size_t, 2> count_ = {0, 0};
};

// Lists the bricks in [first, last) that are awake or dirty in one of the directions of `to_visit`
// in `found`, and other bricks that are dirty for end points in `end_points`. All are then settled
// until something beside them is removed.
// Needs: first is a multiple of kDirtyGroup; so is last, or the rest of its group is zero. The
//        lists have room for last - first.
void TakeDirty(const DirtyBricks& dirty, size_t first, size_t last, DirtyMask to_visit,
               BrickLists& found, BrickLists& end_points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_WORK_LIST_H_
