#include "core/volume/brick_neighbors.h"

#include "core/exec/huge_pages.h"
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

namespace {

// The difference of the keys of a brick's neighbor and the brick. Fields do not carry into each
// other because each has room for one step below the first brick.
uint64_t KeyStep(Sublattice sublattice, int position) {
  const BrickCoordinates home = {1, 1, 1, sublattice};
  return BrickKey(NeighborBrick(home, position)).value() - BrickKey(home).value();
}

// The bricks whose neighbors are searched.
enum class Seekers : uint8_t { kEven, kAll };

// Finds all neighbors at `position`, and so the reverse ones at `opposite`: adding a constant
// preserves the order of keys, so both lists are walked once.
void LinkPairs(std::span<const BrickKey> keys, Seekers seekers, int position, int opposite,
               std::vector<BrickNeighborhood>& neighbors) {
  const uint64_t step = KeyStep(Sublattice::kEven, position);
  size_t at = 0;
  for (size_t n = 0; n < keys.size(); ++n) {
    if (seekers == Seekers::kEven && keys[n].sublattice() != Sublattice::kEven) continue;
    const uint64_t wanted = keys[n].value() + step;
    while (at < keys.size() && keys[at].value() < wanted) ++at;
    if (at == keys.size()) return;
    if (keys[at].value() != wanted) continue;
    neighbors[n][static_cast<size_t>(position)] = static_cast<BrickIndex>(at);
    neighbors[at][static_cast<size_t>(opposite)] = static_cast<BrickIndex>(n);
  }
}

}  // namespace

std::vector<BrickNeighborhood> FindBrickNeighbors(std::span<const BrickKey> keys) {
  BrickNeighborhood nothing;
  nothing.fill(static_cast<BrickIndex>(keys.size()));
  std::vector<BrickNeighborhood> neighbors;
  exec::ReserveLarge(keys.size(), neighbors);
  neighbors.assign(keys.size(), nothing);
  // If an odd brick is at a position of an even one, the even one is at the same position of the
  // odd one.
  for (int position = 0; position < 8; ++position) {
    LinkPairs(keys, Seekers::kEven, position, position, neighbors);
  }
  for (int position = 8; position < 14; position += 2) {
    LinkPairs(keys, Seekers::kAll, position, position + 1, neighbors);
  }
  return neighbors;
}

std::span<const BrickNeighborhood> LazyBrickNeighbors::Of(std::span<const BrickKey> keys) const {
  if (keys.empty()) return {};
  std::call_once(table_->once, [&] { table_->rows = FindBrickNeighbors(keys); });
  return table_->rows;
}

}  // namespace bccskel
