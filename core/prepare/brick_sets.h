#ifndef BCCSKEL_CORE_PREPARE_BRICK_SETS_H_
#define BCCSKEL_CORE_PREPARE_BRICK_SETS_H_

#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Set operations on points, brick by brick. Needs: both volumes have the same extent.
Volume Union(const Volume& a, const Volume& b);
Volume Difference(const Volume& a, const Volume& b);

// The number of bricks along each axis that cover `reach` lattice units. The sublattice has no
// meaning.
BrickCoordinates RoomFor(double reach);
// The extent in whole bricks, with room on all sides.
LatticeExtent WithRoom(const LatticeExtent& extent, BrickCoordinates room);

// The points moved by `times` times `by` bricks. Needs: they lie in the extent.
Volume ShiftedBy(const Volume& volume, BrickCoordinates by, int32_t times, LatticeExtent extent);

// The keys of an object's bricks, and of all bricks up to `reach` bricks around them, of both
// sublattices, increasing. Needs: no coordinate below `reach`.
std::vector<BrickKey> BricksAround(const Volume& object, BrickCoordinates reach);

// An upper bound of their number, and the memory per key while they are listed.
uint64_t MostBricksAround(const Volume& object, BrickCoordinates reach);
inline constexpr uint64_t kBytesPerListedBrick = 32;

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BRICK_SETS_H_
