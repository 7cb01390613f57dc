#include "core/thinning/thinning_state.h"

#include "core/exec/huge_pages.h"

namespace bccskel {
namespace {

// Which of the 14 neighboring bricks holds a neighbor of a point, and at which bit; position -1 is
// the point's own brick. Depends on the sublattice, the direction and the point's bit alone.
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

NeighborMask ThinningState::NeighborsOf(BrickIndex brick, int bit) const {
  NeighborMask mask = 0;
  for (int n = 0; n < kNeighborCount; ++n) {
    const Direction d(n);
    const NeighborAddress at = NeighborAt(*this, brick, bit, d);
    if (object[at.brick].Test(at.bit)) mask |= d.mask();
  }
  return mask;
}

Volume ThinningState::ToVolume(const Volume& source) && {
  object.pop_back();
  return Volume::FromSortedBricks(source.extent(), source.placement(),
                                  std::vector(keys.begin(), keys.end()), std::move(object));
}

}  // namespace bccskel
