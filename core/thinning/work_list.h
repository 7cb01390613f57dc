#ifndef BCCSKEL_CORE_THINNING_WORK_LIST_H_
#define BCCSKEL_CORE_THINNING_WORK_LIST_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/volume/brick.h"

// Which bricks a pass has to visit again.

namespace bccskel {

// For each brick: bit d says that points may have become removable along direction d, bit 8 that
// there may be end points. A brick whose shell has just opened is awake: every pass visits it,
// whatever these bits say, since nearly all such bricks change and notifying 14 neighbors of
// each change would cost more than a visit. It falls asleep after a cycle in which neither it nor a
// neighboring brick has changed; from then on changes beside it make it dirty. Bits 13 to 15 say
// that it lies beside a sleeping brick and so must notify its neighbors of changes, that some of
// these belong to other workers, and that it is of the odd sublattice.
using DirtyMask = uint16_t;
inline constexpr DirtyMask kEndPointsDirty = 1 << 8;
inline constexpr DirtyMask kDirectionsDirty = kEndPointsDirty - 1;
inline constexpr DirtyMask kAwake = 1 << 9;
inline constexpr DirtyMask kBesideSleeper = 1 << 13;
inline constexpr DirtyMask kBorderBrick = 1 << 14;
inline constexpr DirtyMask kOddBrick = 1 << 15;

// Ranges of bricks start at multiples of this, and arrays of DirtyMask are padded to one.
inline constexpr size_t kDirtyGroup = 32;

// Arrays for all bricks. Copies share them.
struct DirtyBricks {
  DirtyMask* bricks = nullptr;
  // One for each group: 0 says that all its bricks are settled and asleep. Most are, and so passes
  // do not read the bricks.
  uint8_t* groups = nullptr;

  void Add(BrickIndex brick, DirtyMask bits) const {
    bricks[brick] = static_cast<DirtyMask>(bricks[brick] | bits);
    groups[brick / kDirtyGroup] = 1;
  }
};

// Bricks listed for a pass, by sublattice. The storage is as long as the list can get, and a
// register longer; it is never cleared, so refilling it costs nothing.
class BrickLists {
 public:
  void Reserve(size_t bricks) {
    for (std::vector<BrickIndex>& list : storage_) list.resize(bricks + kDirtyGroup);
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

  // Where the next ones go, of which Add() then keeps some.
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

// Lists the bricks in [first, last) that are awake or dirty in one of the directions of
// `to_visit`, and of the others those that are for end points; all are then settled until
// something beside them is removed.
// Needs: first is a multiple of kDirtyGroup, and so is last or the rest of its group is zero;
//        the lists have room for last - first.
void TakeDirty(const DirtyBricks& dirty, size_t first, size_t last, DirtyMask to_visit,
               BrickLists& found, BrickLists& end_points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_WORK_LIST_H_
