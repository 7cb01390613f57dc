#ifndef BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_
#define BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_

#include <array>
#include <bit>
#include <cstdint>

#include "core/lattice/directions.h"
#include "core/topology/simple_point_table.h"

// Everything that a point's 14 neighbors alone decide. A NeighborMask holds the neighbors that are
// object points; the point itself is taken to be an object point. The included header adds
// Condition 1 (simple points).

namespace bccskel {

// Section 2: point classes.
constexpr int NeighborsIn(NeighborMask mask) { return std::popcount(mask); }

// The same for a few neighbors, without a count: baseline x86-64 has no instruction for it.
constexpr NeighborMask WithoutFirst(NeighborMask mask) {
  return static_cast<NeighborMask>(mask & (mask - 1));
}
constexpr bool IsEndPoint(NeighborMask mask) { return mask != 0 && WithoutFirst(mask) == 0; }
constexpr bool IsCurvePoint(NeighborMask mask) { return IsEndPoint(WithoutFirst(mask)); }
constexpr bool HasThreeOrMore(NeighborMask mask) { return WithoutFirst(WithoutFirst(mask)) != 0; }

// For each neighbor n in bit order, the neighbors of n that are neighbors of the point too.
constexpr std::array<NeighborMask, kNeighborCount> ComputeSharedNeighbors() {
  std::array<NeighborMask, kNeighborCount> shared = {};
  for (int a = 0; a < kNeighborCount; ++a) {
    for (int b = 0; b < kNeighborCount; ++b) {
      if (!FindDirection(Direction(b).offset() - Direction(a).offset())) continue;
      shared[static_cast<size_t>(a)] =
          static_cast<NeighborMask>(shared[static_cast<size_t>(a)] | Direction(b).mask());
    }
  }
  return shared;
}
inline constexpr std::array<NeighborMask, kNeighborCount> kSharedNeighbors =
    ComputeSharedNeighbors();

// The neighbors of a point's neighbor n that are neighbors of the point too.
// Source: D8 neighbors share 6 of N14 with the point, D6 neighbors 4; 36 adjacent pairs in all.
constexpr NeighborMask NeighborsAmongN14(Direction n) {
  return kSharedNeighbors[static_cast<size_t>(n.bit())];
}

// The connected component of the neighbors in `start` within `mask`.
constexpr NeighborMask ComponentAround(NeighborMask start, NeighborMask mask) {
  unsigned component = start;
  for (unsigned fresh = component; fresh != 0;) {
    unsigned reached = 0;
    for (; fresh != 0; fresh &= fresh - 1) {
      reached |= kSharedNeighbors[static_cast<size_t>(std::countr_zero(fresh))];
    }
    fresh = reached & mask & ~component;
    component |= fresh;
  }
  return static_cast<NeighborMask>(component);
}

// The one, within `mask`, of its lowest neighbor; 0 for an empty mask.
constexpr NeighborMask FirstComponentIn(NeighborMask mask) {
  return ComponentAround(static_cast<NeighborMask>(mask & (~mask + 1u)), mask);
}

// Connected components of the neighbors in `mask`, by adjacency within N14: C(mask) of section 2.
constexpr int ComponentsIn(NeighborMask mask) {
  int components = 0;
  for (; mask != 0; ++components) mask = static_cast<NeighborMask>(mask ^ FirstComponentIn(mask));
  return components;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_TOPOLOGY_NEIGHBORHOOD_H_
