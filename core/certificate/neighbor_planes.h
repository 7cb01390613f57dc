#ifndef BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_
#define BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_

#include <array>
#include <cstdint>
#include <span>

#include "core/lattice/directions.h"
#include "core/volume/brick.h"
#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"

namespace bccskel {

// Bricks around a brick by their position in a BrickNeighborhood: bit n stands for position n.
using PositionMask = uint32_t;

// A brick and the 14 bricks around it, side by side, in the order of BrickNeighborhood.
struct BrickSurroundings {
  BrickBits own;
  std::array<BrickBits, kNeighborCount> around;
};

// For each direction a plane of 512 bits: whether the neighbor of each point in that direction is a
// point.
using NeighborPlanes = std::array<BrickBits, kNeighborCount>;

NeighborPlanes FindNeighborPlanes(Sublattice sublattice, const BrickSurroundings& bricks);
NeighborPlanes NeighborPlanesOf(const Volume& object, BrickIndex brick);

inline NeighborMask NeighborsAt(int bit, const NeighborPlanes& planes) {
  unsigned mask = 0;
  for (size_t n = 0; n < planes.size(); ++n) mask |= (planes[n].Test(bit) ? 1u : 0u) << n;
  return static_cast<NeighborMask>(mask);
}

// The points that lack a neighbor.
inline BrickBits BorderOf(const BrickBits& points, const NeighborPlanes& planes) {
  BrickBits surrounded = points;
  for (const BrickBits& plane : planes) surrounded &= plane;
  return points & ~surrounded;
}

// The bricks around brick `n`, which is of `sublattice`, that hold a neighbor of one of its points.
// Shapes: `bricks` has all that `neighbors`, the neighborhood of n, names.
PositionMask FindTouchedBricks(Sublattice sublattice, std::span<const BrickBits> bricks,
                               BrickIndex n, const BrickNeighborhood& neighbors);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_CERTIFICATE_NEIGHBOR_PLANES_H_
