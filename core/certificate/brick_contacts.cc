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

BrickBits PointsTouching(Sublattice sublattice, Direction d, BrickCoordinates other) {
  BrickBits points;
  for (int bit = 0; bit < kBrickPoints; ++bit) {
    if (NeighborAddress(sublattice, d, bit).brick == other) points.Set(bit);
  }
  return points;
}

BrickContacts ComputeContacts(Sublattice sublattice) {
  BrickContacts contacts;
  for (int position = 0; position < kNeighborCount; ++position) {
    const auto p = static_cast<size_t>(position);
    const BrickCoordinates other = NeighborBrick(SomeBrick(sublattice), position);
    for (int d = 0; d < kNeighborCount; ++d) {
      const BrickBits points = PointsTouching(sublattice, Direction(d), other);
      if (points.Empty()) continue;
      contacts.at[p].push_back({position, Direction(d), points});
      contacts.along[static_cast<size_t>(d)].push_back(contacts.at[p].back());
      for (size_t k = 0; k < 8; ++k) contacts.points_at[p].words[k] |= points.words[k];
    }
    std::ranges::stable_sort(contacts.at[p], std::greater<>(),
                             [](const BrickContact& contact) { return contact.points.Count(); });
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
