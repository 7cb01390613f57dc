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
//   [0..7]  the other sublattice; per axis the same brick or the previous (even brick) or next (odd
//           brick) one: bit 0 of the position stands for a step along x, bit 1 along y, bit 2 along
//           z; [0] is the brick at the same coordinates.
//   [8..13] the same sublattice, one brick along +x, -x, +y, -y, +z, -z.
// A brick that is not stored has the index of the padding brick, keys.size().
using BrickNeighborhood = std::array<BrickIndex, 14>;

// Shapes: `keys` strictly increasing; one neighborhood per key.
// Cost:   11 linear merges of the key list with itself.
std::vector<BrickNeighborhood> FindBrickNeighbors(std::span<const BrickKey> keys);

// The neighborhoods for one list of keys, computed on first use and shared by copies.
class LazyBrickNeighbors {
 public:
  // Needs: the same keys in every call.
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
