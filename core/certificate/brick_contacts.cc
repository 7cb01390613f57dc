#include "core/certificate/brick_contacts.h"

#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

// A brick far enough from the origin that all its neighbors have coordinates >= 0.
constexpr BrickCoordinates SomeBrick(Sublattice sublattice) { return {1, 1, 1, sublattice}; }

BrickAddress NeighborAddress(Sublattice sublattice, Direction d, int bit) {
  return AddressOf(PointOf(SomeBrick(sublattice), bit) + d.offset());
}

BrickBits PointsTouching(Sublattice sublattice, Direction d, BrickCoordinates other) {
  BrickBits points;
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    if (NeighborAddress(sublattice, d, bit).brick == other) points.Set(bit);
  }
  return points;
}

PositionMask PositionsBeside(Sublattice sublattice, int position) {
  const BrickCoordinates brick = NeighborBrick(SomeBrick(sublattice), position);
  PositionMask beside = 0;
  for (int other = 0; other < kNeighborCount; ++other) {
    for (int step = 0; step < kNeighborCount; ++step) {
      const bool touches =
          NeighborBrick(brick, step) == NeighborBrick(SomeBrick(sublattice), other);
      beside |= (touches ? 1u : 0u) << other;
    }
  }
  return beside;
}

BrickContacts ComputeContacts(Sublattice sublattice) {
  BrickContacts contacts;
  for (int position = 0; position < kNeighborCount; ++position) {
    const auto p = static_cast<size_t>(position);
    const BrickCoordinates other = NeighborBrick(SomeBrick(sublattice), position);
    for (int d = 0; d < kNeighborCount; ++d) {
      const BrickBits points = PointsTouching(sublattice, Direction(d), other);
      if (points.Empty()) continue;
      contacts.along[static_cast<size_t>(d)].push_back({position, points});
      for (size_t k = 0; k < 8; ++k) contacts.points_at[p].words[k] |= points.words[k];
    }
    contacts.beside[p] = PositionsBeside(sublattice, position);
  }
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
