#ifndef BCCSKEL_CORE_THINNING_UNSETTLED_H_
#define BCCSKEL_CORE_THINNING_UNSETTLED_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/lattice/directions.h"
#include "core/shells/slice_bricks.h"
#include "core/thinning/mark_removable.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"

// Which bricks a pass has to visit again, and the brick operations around the marking of a pass.

namespace bccskel {

// For each brick: bit d says that points may have become removable along direction d, bit 8 that
// there may be end points. A brick whose shell has just opened is awake: every pass visits it,
// whatever these bits say, since nearly all such bricks change and notifying 14 neighbors of
// each change would cost more than a visit. It falls asleep after a cycle in which neither it nor a
// neighboring brick has changed; from then on changes beside it unsettle it. Bits 13 to 15 say that
// it lies beside a sleeping brick and so must notify its neighbors of changes, that some of these
// belong to other workers, and that it is of the odd sublattice.
using Unsettled = uint16_t;
inline constexpr Unsettled kEndPointsUnsettled = 1 << 8;
inline constexpr Unsettled kDirectionsUnsettled = kEndPointsUnsettled - 1;
inline constexpr Unsettled kAwake = 1 << 9;
inline constexpr Unsettled kBesideSleeper = 1 << 13;
inline constexpr Unsettled kBorderBrick = 1 << 14;
inline constexpr Unsettled kOddBrick = 1 << 15;

// Ranges of bricks start at multiples of this, and arrays of Unsettled are padded to one.
inline constexpr size_t kUnsettledGroup = 32;

// Arrays for all bricks. Copies share them.
struct UnsettledBricks {
  Unsettled* bricks = nullptr;
  // One for each group: 0 says that all its bricks are settled and asleep. Most are, and so passes
  // do not read the bricks.
  uint8_t* groups = nullptr;

  void Add(BrickIndex brick, Unsettled bits) const {
    bricks[brick] = static_cast<Unsettled>(bricks[brick] | bits);
    groups[brick / kUnsettledGroup] = 1;
  }
};

// Bricks listed for a pass, by sublattice. The storage is as long as the list can get, and a
// register longer; it is never cleared, so refilling it costs nothing.
class BrickLists {
 public:
  void Reserve(size_t bricks) {
    for (std::vector<BrickIndex>& list : storage_) list.resize(bricks + kUnsettledGroup);
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

// Lists the bricks in [first, last) that are awake or unsettled in one of the directions of
// `looked_for`, and of the others those that are for end points; all are then settled until
// something beside them is removed.
// Needs: first is a multiple of kUnsettledGroup, and so is last or the rest of its group is zero;
//        the lists have room for last - first.
void TakeUnsettled(const UnsettledBricks& unsettled, size_t first, size_t last,
                   Unsettled looked_for, BrickLists& found, BrickLists& end_points);

// What a removal changes.
struct RemovalView {
  BrickBits* object = nullptr;
  const BrickBits* candidates = nullptr;
  const BrickNeighborhood* neighbors = nullptr;
  UnsettledBricks unsettled;
  Unsettled* enabled = nullptr;  // what may become unsettled; 0 while there are no candidates
  int32_t* changed = nullptr;    // the cycle in which points were last removed
  int32_t cycle = 0;
  BrickIndex first = 0;  // own bricks
  BrickIndex last = 0;
  BrickIndex none = 0;  // the padding brick
};

// Removes the marked points, unsettles the sleeping bricks that see them, and appends to
// `elsewhere` those outside [first, last). Returns: the number of points removed.
uint64_t RemoveMarked(const RemovalView& view, std::span<const MarkedBrick> marked,
                      std::vector<BrickIndex>& elsewhere);

// Shells that are cut out of the planes together: planes lie far away, six to a brick, and would
// otherwise be read for every shell. Whole groups of them share all but two planes.
inline constexpr int32_t kShellsAtOnce = 4;

// The points of the shells from `first` on, modulo 64.
// Shapes: `points` has room for kShellsAtOnce times the bricks; those of shell first + k in the
//         bricks begin at k times the number of bricks.
// Needs:  first is a multiple of kShellsAtOnce.
void CutShells(std::span<const ShellPlanes> planes, int32_t first,
               std::span<const BrickIndex> bricks, BrickBits* points);

// What opening a shell reads and changes.
struct OpeningView {
  const BrickBits* object = nullptr;
  const BrickBits* kept = nullptr;  // points that never go; null if there are none
  BrickBits* candidates = nullptr;
  UnsettledBricks unsettled;
  Unsettled* enabled = nullptr;
  Unsettled watched = 0;  // the bits of a brick with candidates
  Unsettled woken = 0;    // the bits of a brick with new candidates
};

// Condition 5: makes the points of one shell in the given bricks candidates.
// Shapes: `points` are those of the shell, as many as bricks. Returns: how many points.
uint64_t OpenShell(const OpeningView& view, std::span<const BrickIndex> bricks,
                   const BrickBits* points);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_UNSETTLED_H_
