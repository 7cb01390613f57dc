#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_

#include <array>
#include <vector>

#include "core/certificate/neighbor_planes.h"
#include "core/lattice/directions.h"
#include "core/volume/brick.h"

namespace bccskel {

// The points of a brick whose neighbor in one direction lies in one other brick.
struct BrickContact {
  int position;  // which brick, as in BrickNeighborhood
  BrickBits points;
};

// Where the bricks of one sublattice touch their 14 neighboring bricks.
struct BrickContacts {
  // By direction: at most eight contacts for D8, one for D6.
  std::array<std::vector<BrickContact>, kNeighborCount> along;
  // By position: all points with any neighbor in the brick there.
  std::array<BrickBits, kNeighborCount> points_at;
  // By position: the other positions around the brick at which bricks touch the one there.
  std::array<PositionMask, kNeighborCount> beside;
};

// Threads: safe; the tables are filled on first use.
const BrickContacts& ContactsOf(Sublattice sublattice);

// The bit, in its own brick, of the neighbor in direction `d` of the point `bit`.
int NeighborBit(Sublattice sublattice, Direction d, int bit);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_
