#ifndef BCCSKEL_CORE_LATTICE_DIRECTIONS_H_
#define BCCSKEL_CORE_LATTICE_DIRECTIONS_H_

#include <array>
#include <bit>
#include <cstdint>
#include <optional>

#include "core/lattice/lattice_point.h"

namespace bccskel {

// A set of neighbors of a point: bit n stands for the neighbor at kDirections14[n].
using NeighborMask = uint16_t;
inline constexpr int kNeighborCount = 14;
inline constexpr NeighborMask kAllNeighbors = (1u << kNeighborCount) - 1;

// The offsets of N14 (section 2). Bits 0..7 are D8: bit 0 of the index is the sign of x, bit 1 of
// y, bit 2 of z. Bits 8..13 are D6: +x, -x, +y, -y, +z, -z. The order is part of the public
// contract: results that break ties by neighbor rank and the published table hashes depend on it.
inline constexpr std::array<LatticePoint, kNeighborCount> kDirections14 = {{
    {-1, -1, -1},
    {+1, -1, -1},
    {-1, +1, -1},
    {+1, +1, -1},
    {-1, -1, +1},
    {+1, -1, +1},
    {-1, +1, +1},
    {+1, +1, +1},
    {+2, 0, 0},
    {-2, 0, 0},
    {0, +2, 0},
    {0, -2, 0},
    {0, 0, +2},
    {0, 0, -2},
}};

// An index into kDirections14.
class Direction {
 public:
  constexpr explicit Direction(int bit) : bit_(static_cast<uint8_t>(bit)) {}  // Needs: 0..13.
  constexpr int bit() const { return bit_; }
  constexpr LatticePoint offset() const { return kDirections14[bit_]; }
  constexpr bool is_diagonal() const { return bit_ < 8; }
  constexpr NeighborMask mask() const { return static_cast<NeighborMask>(1u << bit_); }
  constexpr Direction Opposite() const { return Direction(is_diagonal() ? 7 - bit_ : bit_ ^ 1); }
  friend constexpr bool operator==(Direction, Direction) = default;

 private:
  uint8_t bit_;
};

constexpr NeighborMask With(NeighborMask mask, Direction d) {
  return static_cast<NeighborMask>(mask | d.mask());
}
constexpr NeighborMask Without(NeighborMask mask, Direction d) {
  return static_cast<NeighborMask>(mask & ~d.mask());
}

// Calls visit(Direction) for the directions in `mask`, in order.
template <typename Visit>
void ForEachDirection(NeighborMask mask, Visit visit) {
  for (unsigned rest = mask; rest != 0; rest &= rest - 1) {
    visit(Direction(std::countr_zero(rest)));
  }
}

// One of the eight thinning directions of D8.
class DiagonalDirection {
 public:
  constexpr explicit DiagonalDirection(int bit)
      : bit_(static_cast<uint8_t>(bit)) {}  // Needs: 0..7.
  constexpr int bit() const { return bit_; }
  constexpr operator Direction() const { return Direction(bit_); }  // NOLINT: it is a Direction
  constexpr LatticePoint offset() const { return kDirections14[bit_]; }
  friend constexpr bool operator==(DiagonalDirection, DiagonalDirection) = default;

 private:
  uint8_t bit_;
};

// The direction with this offset, if it is one of N14.
constexpr std::optional<Direction> FindDirection(LatticePoint offset) {
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if (kDirections14[static_cast<size_t>(bit)] == offset) return Direction(bit);
  }
  return std::nullopt;
}

// Dot product of two offsets.
constexpr int Dot(LatticePoint a, LatticePoint b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

constexpr bool OppositesCancel() {
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    if (d.offset() + d.Opposite().offset() != LatticePoint{}) return false;
  }
  return true;
}
static_assert(OppositesCancel());

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LATTICE_DIRECTIONS_H_
