#include "core/topology/checking_rings.h"

#include <algorithm>
#include <cstddef>

#include "core/topology/neighborhood.h"

namespace bccskel {
namespace {

constexpr LatticePoint Cross(LatticePoint a, LatticePoint b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}

// R(p, axial, diagonal). The plane through p spanned by the two directions contains every neighbor
// normal to their cross product; in N14 these are integer combinations of the two.
constexpr NeighborMask RingSpannedBy(Direction axial, DiagonalDirection diagonal) {
  const LatticePoint normal = Cross(axial.offset(), diagonal.offset());
  unsigned ring = 0;
  for (int n = 0; n < kNeighborCount; ++n) {
    if (Dot(normal, Direction(n).offset()) == 0) ring |= Direction(n).mask();
  }
  return static_cast<NeighborMask>(ring);
}

// +x, +y and +z also represent their opposites: both span the same ring.
constexpr std::array<Direction, 3> kAxes = {Direction(8), Direction(10), Direction(12)};

constexpr std::array<NeighborMask, 3> RingsThrough(DiagonalDirection d) {
  return {RingSpannedBy(kAxes[0], d), RingSpannedBy(kAxes[1], d), RingSpannedBy(kAxes[2], d)};
}

constexpr std::array<NeighborMask, kCheckingRingCount> AllRings() {
  std::array<NeighborMask, kCheckingRingCount> rings = {};
  size_t count = 0;
  for (int d = 0; d < 8; ++d) {
    for (NeighborMask ring : RingsThrough(DiagonalDirection(d))) {
      const auto end = rings.begin() + count;
      if (std::find(rings.begin(), end, ring) == end) rings[count++] = ring;
    }
  }
  return rings;
}

constexpr std::array<NeighborMask, kCheckingRingCount> kCheckingRings = AllRings();

constexpr std::array<std::array<NeighborMask, 3>, 8> kRingsThrough = {
    RingsThrough(DiagonalDirection(0)), RingsThrough(DiagonalDirection(1)),
    RingsThrough(DiagonalDirection(2)), RingsThrough(DiagonalDirection(3)),
    RingsThrough(DiagonalDirection(4)), RingsThrough(DiagonalDirection(5)),
    RingsThrough(DiagonalDirection(6)), RingsThrough(DiagonalDirection(7))};

constexpr bool EachHasSixPoints() {
  return std::all_of(kCheckingRings.begin(), kCheckingRings.end(),
                     [](NeighborMask ring) { return NeighborsIn(ring) == 6; });
}
constexpr bool OppositesShareTheirRings() {
  for (int d = 0; d < 8; ++d) {
    if (kRingsThrough[static_cast<size_t>(d)] != kRingsThrough[static_cast<size_t>(7 - d)]) {
      return false;
    }
  }
  return true;
}
static_assert(EachHasSixPoints());
static_assert(OppositesShareTheirRings());

}  // namespace

const std::array<NeighborMask, kCheckingRingCount>& CheckingRings() { return kCheckingRings; }

std::array<NeighborMask, 3> CheckingRingsThrough(DiagonalDirection d) {
  return kRingsThrough[static_cast<size_t>(d.bit())];
}

bool SatisfiesCheckingRings(NeighborMask mask, DiagonalDirection d) {
  for (NeighborMask ring : kRingsThrough[static_cast<size_t>(d.bit())]) {
    if (ComponentsIn(mask & ring) != 1) return false;
  }
  return true;
}

}  // namespace bccskel
