#ifndef BCCSKEL_CORE_TOPOLOGY_CHECKING_RINGS_H_
#define BCCSKEL_CORE_TOPOLOGY_CHECKING_RINGS_H_

#include <array>

#include "core/lattice/directions.h"

namespace bccskel {

// The six checking rings: the neighbors on one grid plane through the point spanned by a D6 and a
// D8 direction (section 3). Each has six points.
inline constexpr int kCheckingRingCount = 6;
const std::array<NeighborMask, kCheckingRingCount>& CheckingRings();

// The three rings that contain d; d and -d share them.
std::array<NeighborMask, 3> CheckingRingsThrough(DiagonalDirection d);

// Condition 3: on every checking ring through d the object part is one component. "For any d1"
// reads "for every d1": with "for some d1" the rule breaks topology.
bool SatisfiesCheckingRings(NeighborMask mask, DiagonalDirection d);

}  // namespace bccskel

#endif  // BCCSKEL_CORE_TOPOLOGY_CHECKING_RINGS_H_
