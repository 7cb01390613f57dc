#include "core/thinning/thinning_state.h"

#include "core/exec/huge_pages.h"

namespace bccskel {
namespace {

// Which of the 14 neighboring bricks holds a neighbor of a point, and at which bit; position -1 is
// the point's own brick. Depends only on the sublattice, the direction and the point's bit.
struct Hop {
  int8_t position;
  int16_t bit;
};

constexpr Hop FindHop(Sublattice sublattice, int bit, int direction) {
  // A brick far enough from the origin that all its neighbors have positive coordinates.
  const BrickCoordinates home = {1, 1, 1, sublattice};
  const LatticePoint from = PointOf(home, bit);
  const BrickAddress to = AddressOf(from + kDirections14[static_cast<size_t>(direction)]);
  const int dx = to.brick.bx - home.bx, dy = to.brick.by - home.by, dz = to.brick.bz - home.bz;
  if (direction < 8) {
    const int position = (dx != 0 ? 1 : 0) | (dy != 0 ? 2 : 0) | (dz != 0 ? 4 : 0);
    return {static_cast<int8_t>(position), static_cast<int16_t>(to.bit)};
  }
  if (dx == 0 && dy == 0 && dz == 0) return {-1, static_cast<int16_t>(to.bit)};
  return {static_cast<int8_t>(direction), static_cast<int16_t>(to.bit)};
}

using HopTable = std::array<std::array<std::array<Hop, kNeighborCount>, kBrickPoints>, 2>;

const HopTable& Hops() {
  static const HopTable table = [] {
    HopTable hops;
    for (Sublattice sublattice : kSublattices) {
      for (int bit = 0; bit < kBrickPoints; ++bit) {
        for (int d = 0; d < kNeighborCount; ++d) {
          hops[static_cast<size_t>(sublattice)][static_cast<size_t>(bit)][static_cast<size_t>(d)] =
              FindHop(sublattice, bit, d);
        }
      }
    }
    return hops;
  }();
  return table;
}

}  // namespace

ThinningState::ThinningState(const Volume& volume, std::span<const LatticePoint> keep)
    : keys(volume.keys()), neighbors(volume.neighbors()) {
  exec::ReserveLarge(volume.brick_count() + 1, object);
  object.assign(volume.padded_bricks().begin(), volume.padded_bricks().end());
  candidates.assign(volume.brick_count(), BrickBits());
  for (LatticePoint p : keep) {
    if (!volume.Contains(p)) continue;
    if (kept.empty()) kept.resize(volume.brick_count());
    const BrickAddress address = AddressOf(p);
    kept[*volume.Find(BrickKey(address.brick))].Set(address.bit);
  }
}

NeighborAddress NeighborAt(const ThinningState& state, BrickIndex brick, int bit, Direction d) {
  const Hop hop = Hops()[static_cast<size_t>(state.SublatticeOf(brick))][static_cast<size_t>(bit)]
                        [static_cast<size_t>(d.bit())];
  if (hop.position < 0) return {brick, hop.bit};
  return {state.neighbors[brick][static_cast<size_t>(hop.position)], hop.bit};
}

// Most diagonal neighbors lie in one brick, in pairs of adjacent bits of a word.
unsigned ThinningState::DiagonalNeighborsOf(BrickIndex brick, int bit) const {
  const int back = SublatticeOf(brick) == Sublattice::kEven ? 1 : 0;
  const int i = (bit & 15) - back, j = ((bit >> 4) & 3) - back, k = (bit >> 6) - back;
  unsigned mask = 0;
  if (i >= 0 && j >= 0 && k >= 0 && i + 1 < kBrickX && j + 1 < kBrickY && k + 1 < kBrickZ) {
    const BrickBits& other = object[neighbors[brick][0]];
    for (int z : {0, 1}) {
      const uint64_t pairs = other.words[static_cast<size_t>(k + z)] >> (16 * j + i);
      mask |= static_cast<unsigned>((pairs & 3) | (pairs >> 14 & 12)) << (4 * z);
    }
    return mask;
  }
  for (int n = 0; n < 8; ++n) {
    const NeighborAddress at = NeighborAt(*this, brick, bit, Direction(n));
    mask |= (object[at.brick].Test(at.bit) ? 1u : 0u) << n;
  }
  return mask;
}

NeighborMask ThinningState::NeighborsOf(BrickIndex brick, int bit) const {
  constexpr std::array<int, 3> kCells = {kBrickX, kBrickY, kBrickZ}, kUnits = {1, 16, 64};
  const std::array<int, 3> cell = {bit & 15, (bit >> 4) & 3, bit >> 6};
  const auto test = [&](bool inside, size_t position, int there, int beyond) {
    return inside ? object[brick].Test(there) : object[neighbors[brick][position]].Test(beyond);
  };
  unsigned mask = DiagonalNeighborsOf(brick, bit);
  for (size_t axis = 0; axis < 3; ++axis) {
    const int unit = kUnits[axis], across = (kCells[axis] - 1) * unit;
    const size_t up = 8 + 2 * axis, down = up + 1;
    const bool above = test(cell[axis] + 1 < kCells[axis], up, bit + unit, bit - across);
    const bool below = test(cell[axis] > 0, down, bit - unit, bit + across);
    mask |= (above ? 1u : 0u) << up | (below ? 1u : 0u) << down;
  }
  return static_cast<NeighborMask>(mask);
}

Volume ThinningState::ToVolume(const Volume& source) && {
  object.pop_back();
  return Volume::FromSortedBricks(source.extent(), source.placement(),
                                  std::vector(keys.begin(), keys.end()), std::move(object));
}

}  // namespace bccskel
