#ifndef BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_
#define BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_

#include <array>
#include <bit>
#include <cstdint>

#include "core/lattice/directions.h"

// Everything that a point's 14 neighbors alone decide. A NeighborMask holds the neighbors that are
// object points.

namespace bccskel {

// Section 2. The point itself is taken to be an object point.
constexpr int NeighborsIn(NeighborMask mask) { return std::popcount(mask); }
constexpr bool IsIsolatedPoint(NeighborMask mask) { return NeighborsIn(mask) == 0; }
constexpr bool IsEndPoint(NeighborMask mask) { return NeighborsIn(mask) == 1; }
constexpr bool IsCurvePoint(NeighborMask mask) { return NeighborsIn(mask) == 2; }
constexpr bool IsDirectedBorderPoint(NeighborMask mask, Direction d) {
  return (mask & d.Opposite().mask()) == 0;
}
constexpr bool HasSequelPoint(NeighborMask mask, Direction d) { return (mask & d.mask()) != 0; }

// The neighbors of a point's neighbor n that are neighbors of the point too.
// Source: D8 neighbors share 6 of N14 with the point, D6 neighbors 4; 36 adjacent pairs in all.
NeighborMask NeighborsAmongN14(Direction n);

// Connected components of the neighbors in `mask`, by adjacency within N14.
int ComponentsIn(NeighborMask mask);

// Condition 1: one component of object and one of background neighbors (section 3).
bool IsSimple(NeighborMask mask);
// Conditions 1 and 2: simple and more than one object neighbor.
bool IsSimpleNonEnd(NeighborMask mask);

// The six checking rings: the neighbors on one grid plane through the point spanned by a D6 and a
// D8 direction (section 3). Each has six points.
inline constexpr int kCheckingRingCount = 6;
const std::array<NeighborMask, kCheckingRingCount>& CheckingRings();
// The three rings that contain d; d and -d share them.
std::array<NeighborMask, 3> CheckingRingsThrough(DiagonalDirection d);

// Condition 3: on every checking ring through d the object part is one component. "For any d1"
// reads "for every d1": with "for some d1" the rule breaks topology.
bool SatisfiesCheckingRings(NeighborMask mask, DiagonalDirection d);

// Border in direction d and Conditions 1 to 4: removable in a parallel pass along d.
bool IsRemovable(NeighborMask mask, DiagonalDirection d);

// All directions in which IsRemovable holds, as bits 0..7.
uint8_t RemovableDirections(NeighborMask mask);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_
