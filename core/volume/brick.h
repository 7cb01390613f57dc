#ifndef BCCSKEL_CORE_VOLUME_BRICK_H_
#define BCCSKEL_CORE_VOLUME_BRICK_H_

#include <array>
#include <bit>
#include <compare>
#include <cstddef>
#include <cstdint>

#include "core/lattice/lattice_point.h"

namespace bccskel {

// A brick is 16 (x) by 4 (y) by 8 (z) cells of one sublattice: 512 points, one cache line. Word k
// holds layer k; bit 16 * j + i of the word is the cell (i, j, k) of the brick. So a step in x is a
// shift within 16-bit lanes, a step in y a shift of the 64-bit word, and a step in z the next word.
inline constexpr int32_t kBrickX = 16;
inline constexpr int32_t kBrickY = 4;
inline constexpr int32_t kBrickZ = 8;
inline constexpr int kBrickPoints = kBrickX * kBrickY * kBrickZ;

struct alignas(64) BrickBits {
  std::array<uint64_t, 8> words = {};

  friend bool operator==(const BrickBits&, const BrickBits&) = default;
  BrickBits& operator|=(const BrickBits& other) {
    for (size_t k = 0; k < words.size(); ++k) words[k] |= other.words[k];
    return *this;
  }
  BrickBits& operator&=(const BrickBits& other) {
    for (size_t k = 0; k < words.size(); ++k) words[k] &= other.words[k];
    return *this;
  }
  BrickBits operator|(const BrickBits& other) const { return BrickBits(*this) |= other; }
  BrickBits operator&(const BrickBits& other) const { return BrickBits(*this) &= other; }
  BrickBits operator~() const {
    BrickBits rest;
    for (size_t k = 0; k < words.size(); ++k) rest.words[k] = ~words[k];
    return rest;
  }

  bool Empty() const {
    uint64_t any = 0;
    for (uint64_t word : words) any |= word;
    return any == 0;
  }
  uint64_t Count() const {
    uint64_t count = 0;
    for (uint64_t word : words) count += static_cast<uint64_t>(std::popcount(word));
    return count;
  }
  // `bit` is 0..511: 64 * k + 16 * j + i.
  bool Test(int bit) const { return (words[static_cast<size_t>(bit >> 6)] >> (bit & 63)) & 1; }
  void Set(int bit) { words[static_cast<size_t>(bit >> 6)] |= uint64_t{1} << (bit & 63); }
  void Clear(int bit) { words[static_cast<size_t>(bit >> 6)] &= ~(uint64_t{1} << (bit & 63)); }

  // Calls visit(bit) for every set bit in increasing order.
  template <typename Visit>
  void ForEachSetBit(Visit visit) const {
    for (int k = 0; k < kBrickZ; ++k) {
      for (uint64_t rest = words[static_cast<size_t>(k)]; rest != 0; rest &= rest - 1) {
        visit(64 * k + std::countr_zero(rest));
      }
    }
  }
};
static_assert(sizeof(BrickBits) == 64);

// The coordinates of a brick, in units of bricks, and its sublattice. Ordered by (bz, by, bx,
// sublattice), the order in which a Volume stores its bricks.
struct BrickCoordinates {
  int32_t bx = 0;
  int32_t by = 0;
  int32_t bz = 0;
  Sublattice sublattice = Sublattice::kEven;

  friend constexpr bool operator==(const BrickCoordinates&, const BrickCoordinates&) = default;
};

// BrickCoordinates packed into one integer that sorts in the same order: bz, by, bx with 21 bits
// each, offset by one so that the neighbor below the first brick has a key too, then the
// sublattice.
class BrickKey {
 public:
  static constexpr int kAtY = 22, kAtZ = 43;  // the lowest bits of by and bz

  constexpr BrickKey() = default;
  constexpr explicit BrickKey(BrickCoordinates c)
      : value_(Field(c.bz) << kAtZ | Field(c.by) << kAtY | Field(c.bx) << 1 |
               static_cast<uint64_t>(c.sublattice)) {}

  constexpr uint64_t value() const { return value_; }
  constexpr Sublattice sublattice() const { return static_cast<Sublattice>(value_ & 1); }
  constexpr BrickCoordinates coordinates() const {
    return {Unfield(value_ >> 1), Unfield(value_ >> kAtY), Unfield(value_ >> kAtZ), sublattice()};
  }
  friend constexpr auto operator<=>(const BrickKey&, const BrickKey&) = default;

 private:
  static constexpr uint64_t kFieldMask = (uint64_t{1} << 21) - 1;
  static constexpr uint64_t Field(int32_t v) { return static_cast<uint64_t>(v + 1) & kFieldMask; }
  static constexpr int32_t Unfield(uint64_t v) { return static_cast<int32_t>(v & kFieldMask) - 1; }
  uint64_t value_ = 0;
};

// Position of a brick in its Volume.
using BrickIndex = uint32_t;

// A lattice point as brick and bit. Needs: IsOnLattice(p), coordinates >= 0.
struct BrickAddress {
  BrickCoordinates brick;
  int bit = 0;
};
constexpr BrickAddress AddressOf(LatticePoint p) {
  const int32_t i = p.x >> 1, j = p.y >> 1, k = p.z >> 1;  // floor: drops an odd point's half cell
  return {{i >> 4, j >> 2, k >> 3, SublatticeOf(p)}, 64 * (k & 7) + 16 * (j & 3) + (i & 15)};
}
constexpr LatticePoint PointOf(BrickCoordinates brick, int bit) {
  return PointAt(brick.sublattice, brick.bx * kBrickX + (bit & 15),
                 brick.by * kBrickY + ((bit >> 4) & 3), brick.bz * kBrickZ + (bit >> 6));
}

// The bounding box of the points of a brick.
constexpr LatticeBox BoxOf(BrickCoordinates brick) {
  return {PointOf(brick, 0), PointOf(brick, kBrickPoints - 1)};
}

// The points of a brick that lie in the box.
constexpr BrickBits PointsIn(BrickCoordinates brick, const LatticeBox& box) {
  const LatticePoint first = PointOf(brick, 0);
  const auto [low, high] = box;
  uint64_t row = 0, layer = 0;
  for (int32_t n = 0; n < kBrickX; ++n) {
    const int32_t x = first.x + 2 * n;
    if (low.x <= x && x <= high.x) row |= uint64_t{1} << n;
  }
  for (int32_t n = 0; n < kBrickY; ++n) {
    const int32_t y = first.y + 2 * n;
    if (low.y <= y && y <= high.y) layer |= row << (kBrickX * n);
  }
  BrickBits bits;
  for (int32_t n = 0; n < kBrickZ; ++n) {
    const int32_t z = first.z + 2 * n;
    if (low.z <= z && z <= high.z) bits.words[static_cast<size_t>(n)] = layer;
  }
  return bits;
}

}  // namespace bccskel

#endif  // BCCSKEL_CORE_VOLUME_BRICK_H_
