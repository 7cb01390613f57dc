#include "core/certificate/brick_contacts.h"

#include <algorithm>

#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

// A brick far enough from the origin that all its neighbors have coordinates >= 0.
constexpr BrickCoordinates SomeBrick(Sublattice sublattice) { return {1, 1, 1, sublattice}; }

BrickAddress NeighborAddress(Sublattice sublattice, Direction d, int bit) {
  return AddressOf(PointOf(SomeBrick(sublattice), bit) + d.offset());
}

using BricksAround = std::array<BrickCoordinates, kNeighborCount>;

BricksAround BricksAroundSome(Sublattice sublattice) {
  BricksAround around;
  for (int position = 0; position < kNeighborCount; ++position) {
    around[static_cast<size_t>(position)] = NeighborBrick(SomeBrick(sublattice), position);
  }
  return around;
}

// By position: the points whose neighbor in direction `d` lies in the brick there.
std::array<BrickBits, kNeighborCount> PointsTouching(Sublattice sublattice, Direction d,
                                                     const BricksAround& around) {
  std::array<BrickBits, kNeighborCount> points;
  auto at = around.begin();
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    const BrickCoordinates other = NeighborAddress(sublattice, d, bit).brick;
    if (other == SomeBrick(sublattice)) continue;
    if (*at != other) at = std::ranges::find(around, other);
    points[static_cast<size_t>(at - around.begin())].Set(bit);
  }
  return points;
}

PositionMask PositionsBeside(const BricksAround& around, size_t position) {
  PositionMask beside = 0;
  for (int step = 0; step < kNeighborCount; ++step) {
    const auto other = std::ranges::find(around, NeighborBrick(around[position], step));
    if (other != around.end()) beside |= 1u << (other - around.begin());
  }
  return beside;
}

BrickContacts ComputeContacts(Sublattice sublattice) {
  BrickContacts contacts;
  const BricksAround around = BricksAroundSome(sublattice);
  for (int d = 0; d < kNeighborCount; ++d) {
    const auto touching = PointsTouching(sublattice, Direction(d), around);
    for (size_t p = 0; p < touching.size(); ++p) {
      const BrickBits& points = touching[p];
      if (points.Empty()) continue;
      contacts.along[static_cast<size_t>(d)].push_back({static_cast<int>(p), points});
      contacts.points_at[p] |= points;
    }
  }
  for (size_t p = 0; p < around.size(); ++p) contacts.beside[p] = PositionsBeside(around, p);
  return contacts;
}

}  // namespace

const BrickContacts& ContactsOf(Sublattice sublattice) {
  static const std::array<BrickContacts, 2> contacts = {ComputeContacts(Sublattice::kEven),
                                                        ComputeContacts(Sublattice::kOdd)};
  return contacts[static_cast<size_t>(sublattice)];
}

int NeighborBit(Sublattice sublattice, Direction d, int bit) {
  return NeighborAddress(sublattice, d, bit).bit;
}

}  // namespace bccskel
