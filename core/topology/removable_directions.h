#ifndef BCCSKEL_CORE_TOPOLOGY_REMOVABLE_DIRECTIONS_H_
#define BCCSKEL_CORE_TOPOLOGY_REMOVABLE_DIRECTIONS_H_

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/lattice/directions.h"

namespace bccskel {

// "If the neighbor `near` is an object point, so is its neighbor `far` = near + d."
struct Implication {
  Direction near;
  Direction far;

  friend constexpr bool operator==(const Implication&, const Implication&) = default;
};

// Condition 3 for a border point of direction d that has its sequel point: one implication for each
// neighbor `near` with near . d < 0, except -d. In bit order of `near`, so the three diagonal ones
// come first and the three axial ones last.
//
// Why: with p - d background and p + d object, each checking ring through d is a path of five
// around p + d, two points on each side, the outer of which (`near`) is adjacent to the inner
// (`near` + d). The object part is one component iff no outer point lacks its inner one. Condition
// 1 follows: every object neighbor then leads to p + d, every background neighbor to p - d.
constexpr std::array<Implication, 6> ImplicationsOf(DiagonalDirection d) {
  std::array<Implication, 6> implications = {{{d, d}, {d, d}, {d, d}, {d, d}, {d, d}, {d, d}}};
  size_t count = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction near(bit);
    if (Dot(near.offset(), d.offset()) >= 0 || near == Direction(d).Opposite()) continue;
    implications[count++] = {near, *FindDirection(near.offset() + d.offset())};
  }
  return implications;
}

// All directions in which IsRemovable holds, as bits 0..7.
uint8_t RemovableDirections(NeighborMask mask);

// Border in direction d and Conditions 1 to 4: removable in a parallel pass along d.
inline bool IsRemovable(NeighborMask mask, DiagonalDirection d) {
  return ((RemovableDirections(mask) >> d.bit()) & 1) != 0;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_TOPOLOGY_REMOVABLE_DIRECTIONS_H_
