#ifndef BCCSKEL_CORE_VOLUME_BRICK_NEIGHBORS_H_
#define BCCSKEL_CORE_VOLUME_BRICK_NEIGHBORS_H_

#include <array>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/volume/brick.h"

namespace bccskel {

// The 14 bricks that hold the N14 neighbors of a brick's points.
//   [0..7]  the other sublattice, same or one step back (even brick) or forth (odd brick) per axis:
//           bit 0 of the position says a step along x, bit 1 along y, bit 2 along z; [0] is the
//           brick at the same coordinates.
//   [8..13] the same sublattice, one brick along +x, -x, +y, -y, +z, -z.
// A brick that is not stored is given as the index of the padding brick, keys.size().
using BrickNeighborhood = std::array<BrickIndex, 14>;

// Shapes: `keys` strictly increasing; one neighborhood per key.
// Cost:   11 linear merges of the key list with itself.
std::vector<BrickNeighborhood> FindBrickNeighbors(std::span<const BrickKey> keys);

// The table of one list of keys, made on first use and shared by copies.
// Threads: safe.
class LazyBrickNeighbors {
 public:
  // Needs: always the same keys.
  std::span<const BrickNeighborhood> Of(std::span<const BrickKey> keys) const;

  // Independent of the points, so comparisons of volumes ignore it.
  friend bool operator==(const LazyBrickNeighbors&, const LazyBrickNeighbors&) { return true; }

 private:
  struct Table {
    std::once_flag once;
    std::vector<BrickNeighborhood> rows;
  };
  std::shared_ptr<Table> table_ = std::make_shared<Table>();
};

// The offset, in bricks, of neighbor `position` of a brick of `sublattice`.
BrickCoordinates NeighborBrick(BrickCoordinates brick, int position);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_BRICK_NEIGHBORS_H_
