#ifndef BCCSKEL_CORE_LATTICE_LATTICE_POINT_H_
#define BCCSKEL_CORE_LATTICE_LATTICE_POINT_H_

#include <array>
#include <compare>
#include <cstdint>

#include "core/lattice/vectors.h"

// Dictionary of coordinate frames.
//
// Lattice point (x, y, z): three integers of equal parity (section 2: x = y = z mod 2). The unit is
//   half the edge of the cubic cell: D6 neighbors are 2 apart, D8 neighbors sqrt(3).
// Sublattice cell (i, j, k): even points are (2i, 2j, 2k), odd points (2i+1, 2j+1, 2k+1), both with
//   0 <= i < nx, 0 <= j < ny, 0 <= k < nz of the LatticeExtent.
// Brick and bit (core/volume): 16 x 4 x 8 cells of one sublattice are the 512 bits of a brick.
// World: origin + direction * (spacing * (x, y, z) / 2), see Placement. Right-handed unless the
//   direction matrix says otherwise; unit as in the source file.
//
// Everything outside the extent is background.

namespace bccskel {

struct LatticePoint {
  int32_t x = 0;
  int32_t y = 0;
  int32_t z = 0;

  // z is the most significant coordinate: the order in which volumes store and report points.
  friend constexpr std::strong_ordering operator<=>(const LatticePoint& a, const LatticePoint& b) {
    if (auto c = a.z <=> b.z; c != 0) return c;
    if (auto c = a.y <=> b.y; c != 0) return c;
    return a.x <=> b.x;
  }
  friend constexpr bool operator==(const LatticePoint&, const LatticePoint&) = default;
  friend constexpr LatticePoint operator+(LatticePoint a, LatticePoint b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend constexpr LatticePoint operator-(LatticePoint a, LatticePoint b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend constexpr LatticePoint operator-(LatticePoint a) { return {-a.x, -a.y, -a.z}; }
};

// True if all three coordinates have the same parity.
constexpr bool IsOnLattice(LatticePoint p) {
  return ((p.x ^ p.y) & 1) == 0 && ((p.x ^ p.z) & 1) == 0;
}

enum class Sublattice : uint8_t { kEven = 0, kOdd = 1 };
inline constexpr std::array<Sublattice, 2> kSublattices = {Sublattice::kEven, Sublattice::kOdd};

// Needs: IsOnLattice(p).
constexpr Sublattice SublatticeOf(LatticePoint p) {
  return (p.x & 1) != 0 ? Sublattice::kOdd : Sublattice::kEven;
}

constexpr LatticePoint PointAt(Sublattice sublattice, int32_t i, int32_t j, int32_t k) {
  const int32_t odd = static_cast<int32_t>(sublattice);
  return {2 * i + odd, 2 * j + odd, 2 * k + odd};
}

// Cells per axis of each sublattice; the lattice has 2 * nx * ny * nz points.
struct LatticeExtent {
  int32_t nx = 0;
  int32_t ny = 0;
  int32_t nz = 0;

  friend constexpr bool operator==(const LatticeExtent&, const LatticeExtent&) = default;
  constexpr uint64_t PointCount() const {
    return 2 * static_cast<uint64_t>(nx) * static_cast<uint64_t>(ny) * static_cast<uint64_t>(nz);
  }
  // Needs: IsOnLattice(p).
  constexpr bool Contains(LatticePoint p) const {
    return p.x >= 0 && p.y >= 0 && p.z >= 0 && p.x < 2 * nx && p.y < 2 * ny && p.z < 2 * nz;
  }
};

// A box of lattice points, both corners included.
struct LatticeBox {
  LatticePoint low;
  LatticePoint high;

  friend constexpr bool operator==(const LatticeBox&, const LatticeBox&) = default;
  constexpr bool Contains(LatticePoint p) const {
    return p.x >= low.x && p.y >= low.y && p.z >= low.z && p.x <= high.x && p.y <= high.y &&
           p.z <= high.z;
  }
  constexpr bool Contains(const LatticeBox& other) const {
    return Contains(other.low) && Contains(other.high);
  }
  constexpr bool Meets(const LatticeBox& other) const {
    return other.low.x <= high.x && other.low.y <= high.y && other.low.z <= high.z &&
           other.high.x >= low.x && other.high.y >= low.y && other.high.z >= low.z;
  }
};

// Largest number of cells along an axis: lattice coordinates stay exact in a float and brick
// coordinates fit their 21-bit fields.
inline constexpr int32_t kMaxExtentCells = 1 << 22;

using WorldPoint = Vector3<double>;

inline double DistanceBetween(const WorldPoint& a, const WorldPoint& b) {
  return LengthOf(Minus(b, a));
}

// Where the lattice lies in the world. `spacing` is the edge of the cubic cell along each axis;
// `direction` is row-major, its columns are the axes.
struct Placement {
  std::array<double, 3> spacing = {1, 1, 1};
  std::array<double, 3> origin = {0, 0, 0};
  std::array<double, 9> direction = {1, 0, 0, 0, 1, 0, 0, 0, 1};

  friend bool operator==(const Placement&, const Placement&) = default;

  constexpr WorldPoint ToWorld(double x, double y, double z) const {
    const double sx = spacing[0] * x / 2, sy = spacing[1] * y / 2, sz = spacing[2] * z / 2;
    return {origin[0] + (direction[0] * sx + direction[1] * sy + direction[2] * sz),
            origin[1] + (direction[3] * sx + direction[4] * sy + direction[5] * sz),
            origin[2] + (direction[6] * sx + direction[7] * sy + direction[8] * sz)};
  }
  constexpr WorldPoint ToWorld(LatticePoint p) const {
    return ToWorld(static_cast<double>(p.x), static_cast<double>(p.y), static_cast<double>(p.z));
  }
};

}  // namespace bccskel

#endif  // BCCSKEL_CORE_LATTICE_LATTICE_POINT_H_
