#include "core/certificate/brick_contacts.h"

#include <array>
#include <vector>

#include "core/volume/brick_neighbors.h"

namespace bccskel {
namespace {

struct ContactTables {
  // By sublattice and direction, and by sublattice and position.
  std::array<std::array<std::vector<BrickContact>, kNeighborCount>, 2> along;
  std::array<std::array<BrickBits, kNeighborCount>, 2> with;
};

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

ContactTables ComputeTables() {
  ContactTables tables;
  for (Sublattice sublattice : kSublattices) {
    const auto s = static_cast<size_t>(sublattice);
    for (size_t d = 0; d < kNeighborCount; ++d) {
      for (int position = 0; position < kNeighborCount; ++position) {
        const BrickBits points = PointsTouching(sublattice, Direction(static_cast<int>(d)),
                                                NeighborBrick(SomeBrick(sublattice), position));
        if (points.Empty()) continue;
        tables.along[s][d].push_back({position, points});
        BrickBits& with = tables.with[s][static_cast<size_t>(position)];
        for (size_t k = 0; k < 8; ++k) with.words[k] |= points.words[k];
      }
    }
  }
  return tables;
}

const ContactTables& Tables() {
  static const ContactTables tables = ComputeTables();
  return tables;
}

}  // namespace

std::span<const BrickContact> ContactsAlong(Sublattice sublattice, Direction d) {
  return Tables().along[static_cast<size_t>(sublattice)][static_cast<size_t>(d.bit())];
}

const BrickBits& ContactWith(Sublattice sublattice, int position) {
  return Tables().with[static_cast<size_t>(sublattice)][static_cast<size_t>(position)];
}

int NeighborBit(Sublattice sublattice, Direction d, int bit) {
  return NeighborAddress(sublattice, d, bit).bit;
}

}  // namespace bccskel
