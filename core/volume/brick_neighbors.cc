#include "core/volume/brick_neighbors.h"

#include "core/lattice/directions.h"

namespace bccskel {

BrickCoordinates NeighborBrick(BrickCoordinates brick, int position) {
  if (position >= 8) {
    const LatticePoint step = kDirections14[static_cast<size_t>(position)];
    return {brick.bx + step.x / 2, brick.by + step.y / 2, brick.bz + step.z / 2, brick.sublattice};
  }
  // Odd points lie half a cell above the even points of the same index, so the neighbors of an odd
  // cell are at index + 0 or + 1 and those of an even cell at index + 0 or - 1.
  const bool even = brick.sublattice == Sublattice::kEven;
  const int32_t step = even ? -1 : 1;
  return {brick.bx + step * (position & 1), brick.by + step * ((position >> 1) & 1),
          brick.bz + step * (position >> 2), even ? Sublattice::kOdd : Sublattice::kEven};
}

std::vector<BrickNeighborhood> FindBrickNeighbors(std::span<const BrickKey> keys) {
  const auto none = static_cast<BrickIndex>(keys.size());
  std::vector<BrickNeighborhood> neighbors(keys.size());
  for (int position = 0; position < 14; ++position) {
    // The neighbor's key is the key plus a constant that depends on the sublattice only, so for
    // each sublattice both lists are walked in increasing order once.
    size_t cursor[2] = {0, 0};
    for (size_t n = 0; n < keys.size(); ++n) {
      const BrickKey wanted(NeighborBrick(keys[n].coordinates(), position));
      size_t& at = cursor[keys[n].value() & 1];
      while (at < keys.size() && keys[at] < wanted) ++at;
      neighbors[n][static_cast<size_t>(position)] =
          at < keys.size() && keys[at] == wanted ? static_cast<BrickIndex>(at) : none;
    }
  }
  return neighbors;
}

}  // namespace bccskel
