#ifndef BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_
#define BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_

#include <span>

#include "core/lattice/directions.h"
#include "core/volume/brick.h"

namespace bccskel {

// The points of a brick whose neighbor in one direction lies in one other brick.
struct BrickContact {
  int position;  // which brick, as in BrickNeighborhood
  BrickBits points;
};

// All contacts of a direction: eight at most for D8, one for D6.
std::span<const BrickContact> ContactsAlong(Sublattice sublattice, Direction d);

// The points of a brick with any neighbor in the brick at `position`.
const BrickBits& ContactWith(Sublattice sublattice, int position);

// The bit, in its own brick, of the neighbor in direction `d` of the point `bit`.
int NeighborBit(Sublattice sublattice, Direction d, int bit);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_BRICK_CONTACTS_H_
