#ifndef BCCSKEL_CORE_PREPARE_BRICK_SETS_H_
#define BCCSKEL_CORE_PREPARE_BRICK_SETS_H_

#include <cstdint>
#include <vector>

#include "core/volume/volume.h"

namespace bccskel {

// Sets of points, brick by brick. Both have the same extent.
Volume Union(const Volume& a, const Volume& b);
Volume Difference(const Volume& a, const Volume& b);

// Bricks along each axis that cover `reach` lattice units. The sublattice says nothing.
BrickCoordinates RoomFor(double reach);
// Whole bricks, with room on all sides.
LatticeExtent WithRoom(const LatticeExtent& extent, BrickCoordinates room);
// What takes points into an extent with room.
LatticePoint ShiftOf(BrickCoordinates room);

// The same points, so many times `by` farther along each axis. Needs: they lie in the extent.
Volume ShiftedBy(const Volume& volume, BrickCoordinates by, int32_t times, LatticeExtent extent);

// The keys of an object's bricks, of both sublattices, and of all around them up to `reach` bricks
// away, increasing. Needs: no coordinate below `reach`.
std::vector<BrickKey> BricksAround(const Volume& object, BrickCoordinates reach);

// No fewer than these keys, and the memory that each takes until they are listed.
uint64_t MostBricksAround(const Volume& object, BrickCoordinates reach);
inline constexpr uint64_t kBytesPerListedBrick = 32;

}  // namespace bccskel

#endif  // BCCSKEL_CORE_PREPARE_BRICK_SETS_H_
