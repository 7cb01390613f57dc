#ifndef BCCSKEL_CORE_THINNING_REMOVAL_H_
#define BCCSKEL_CORE_THINNING_REMOVAL_H_

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/thinning/mark_removable.h"
#include "core/thinning/work_list.h"
#include "core/volume/brick_neighbors.h"

namespace bccskel {

// Bricks, by the worker that owns them.
using BricksByOwner = std::vector<std::vector<BrickIndex>>;

// What a removal changes.
struct RemovalView {
  BrickBits* object = nullptr;
  const BrickBits* candidates = nullptr;
  const BrickNeighborhood* neighbors = nullptr;
  DirtyBricks dirty;
  DirtyMask* enabled = nullptr;  // bits that may become dirty; 0 while there are no candidates
  int32_t* changed = nullptr;    // the cycle in which points were last removed
  int32_t cycle = 0;
  BrickIndex first = 0;  // own bricks
  BrickIndex last = 0;
  BrickIndex none = 0;               // the padding brick
  const uint16_t* owners = nullptr;  // as BrickShares::owners()
};

// Removes the marked points, makes the sleeping bricks that border on them dirty, and appends those
// outside [first, last) to `elsewhere`. Returns: the number of points removed.
uint64_t RemoveMarked(const RemovalView& view, std::span<const MarkedBrick> marked,
                      BricksByOwner& elsewhere);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_THINNING_REMOVAL_H_
