#include "tests/support/reference_conditions.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstdlib>
#include <vector>

namespace bccskel::test {
namespace {

std::vector<LatticePoint> OffsetsIn(NeighborMask mask) {
  std::vector<LatticePoint> offsets;
  offsets.reserve(kNeighborCount);
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if ((mask >> bit & 1) != 0) offsets.push_back(Direction(bit).offset());
  }
  return offsets;
}

int ObjectComponents(NeighborMask mask) { return CountComponents(OffsetsIn(mask)); }
int BackgroundComponents(NeighborMask mask) {
  return ObjectComponents(static_cast<NeighborMask>(~mask & kAllNeighbors));
}

LatticePoint Times(int factor, LatticePoint p) {
  return {factor * p.x, factor * p.y, factor * p.z};
}

using RingsOfDirection = std::array<NeighborMask, 6>;

// One ring for each d1 in D6; d1 and -d1 give the same one.
std::array<RingsOfDirection, 8> AllCheckingRings() {
  std::array<RingsOfDirection, 8> rings;
  for (size_t d2 = 0; d2 < 8; ++d2) {
    for (size_t d1 = 0; d1 < 6; ++d1) {
      rings[d2][d1] = ReferenceCheckingRing(kDirections14[8 + d1], kDirections14[d2]);
    }
  }
  return rings;
}

std::vector<uint8_t> AllRemovableDirections() {
  std::vector<uint8_t> directions(kAllNeighbors + 1);
  for (size_t n = 0; n < directions.size(); ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    for (int bit = 0; bit < 8; ++bit) {
      const DiagonalDirection d(bit);
      // The cheap conditions first: the order does not change the answer.
      const bool removable = ReferenceIsBorderPoint(mask, d) && ReferenceCondition4(mask, d) &&
                             ReferenceCondition2(mask) && ReferenceCondition1(mask) &&
                             ReferenceCondition3(mask, d);
      directions[n] = static_cast<uint8_t>(directions[n] | removable << bit);
    }
  }
  return directions;
}

// The one neighbor of an end point.
LatticePoint OnlyNeighborOf(const ReferencePointSet& object, LatticePoint p) {
  return p + Direction(std::countr_zero(object.NeighborsOf(p))).offset();
}

bool IsEndPointOf(const ReferencePointSet& object, LatticePoint p) {
  return object.Contains(p) && std::popcount(object.NeighborsOf(p)) == 1;
}

}  // namespace

bool AreNeighbors(LatticePoint p, LatticePoint q) {
  const LatticePoint d = p - q;
  const int sum = std::abs(d.x) + std::abs(d.y) + std::abs(d.z);
  return IsOnLattice(d) && (sum == 2 || sum == 3);
}

int CountComponents(std::span<const LatticePoint> points) {
  std::vector<bool> reached(points.size());
  int components = 0;
  for (size_t start = 0; start < points.size(); ++start) {
    if (reached[start]) continue;
    ++components;
    reached[start] = true;
    std::vector<size_t> open = {start};
    while (!open.empty()) {
      const LatticePoint p = points[open.back()];
      open.pop_back();
      for (size_t n = 0; n < points.size(); ++n) {
        if (reached[n] || !AreNeighbors(p, points[n])) continue;
        reached[n] = true;
        open.push_back(n);
      }
    }
  }
  return components;
}

bool ReferenceCondition1(NeighborMask mask) {
  return ObjectComponents(mask) == 1 && BackgroundComponents(mask) == 1;
}

bool ReferenceIsOneIsthmus(NeighborMask mask) {
  return ObjectComponents(mask) >= 2 && BackgroundComponents(mask) == 1;
}

bool ReferenceIsTwoIsthmus(NeighborMask mask) {
  return ObjectComponents(mask) == 1 && BackgroundComponents(mask) >= 2;
}

bool ReferenceCondition2(NeighborMask mask) { return std::popcount(mask) > 1; }

NeighborMask ReferenceCheckingRing(LatticePoint axial, LatticePoint diagonal) {
  unsigned ring = 0;
  for (int lambda = -3; lambda <= 3; ++lambda) {
    for (int mu = -3; mu <= 3; ++mu) {
      const auto neighbor = FindDirection(Times(lambda, axial) + Times(mu, diagonal));
      if (neighbor) ring |= neighbor->mask();
    }
  }
  return static_cast<NeighborMask>(ring);
}

bool ReferenceCondition3(NeighborMask mask, DiagonalDirection d) {
  static const std::array<RingsOfDirection, 8> rings = AllCheckingRings();
  for (NeighborMask ring : rings[static_cast<size_t>(d.bit())]) {
    if (CountComponents(OffsetsIn(mask & ring)) != 1) return false;
  }
  return true;
}

bool ReferenceCondition4(NeighborMask mask, DiagonalDirection d) {
  return (mask & Direction(d).mask()) != 0;
}

bool ReferenceIsBorderPoint(NeighborMask mask, DiagonalDirection d) {
  return (mask & FindDirection(-d.offset())->mask()) == 0;
}

bool ReferenceIsRemovable(NeighborMask mask, DiagonalDirection d) {
  return (ReferenceRemovableDirections(mask) >> d.bit() & 1) != 0;
}

uint8_t ReferenceRemovableDirections(NeighborMask mask) {
  static const std::vector<uint8_t> directions = AllRemovableDirections();
  return directions[mask];
}

bool ReferenceIsStubble(const ReferencePointSet& object, LatticePoint p) {
  return IsEndPointOf(object, p) &&
         std::popcount(object.NeighborsOf(OnlyNeighborOf(object, p))) > 2;
}

bool ReferenceIsStubbleKeepTwo(const ReferencePointSet& object, LatticePoint p) {
  if (!ReferenceIsStubble(object, p)) return false;
  const LatticePoint q = OnlyNeighborOf(object, p);
  int rank = 0;
  for (int bit = 0; q + Direction(bit).offset() != p; ++bit) {
    if (IsEndPointOf(object, q + Direction(bit).offset())) ++rank;
  }
  return rank < std::popcount(object.NeighborsOf(q)) - 2;
}

}  // namespace bccskel::test
