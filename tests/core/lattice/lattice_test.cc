#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "core/lattice/directions.h"
#include "core/lattice/lattice_point.h"

namespace bccskel {
namespace {

std::vector<LatticePoint> CubeOfIntegers(int32_t low, int32_t high) {
  std::vector<LatticePoint> cube;
  for (int32_t z = low; z <= high; ++z) {
    for (int32_t y = low; y <= high; ++y) {
      for (int32_t x = low; x <= high; ++x) cube.push_back({x, y, z});
    }
  }
  return cube;
}

int SumOfAbs(LatticePoint p) { return std::abs(p.x) + std::abs(p.y) + std::abs(p.z); }
int Remainder(int32_t v) { return ((v % 2) + 2) % 2; }

TEST(LatticePoint, IsOnTheLatticeWhereItsCoordinatesHaveOneParity) {
  for (LatticePoint p : CubeOfIntegers(-4, 4)) {
    const bool one_parity = Remainder(p.x) == Remainder(p.y) && Remainder(p.y) == Remainder(p.z);
    EXPECT_EQ(IsOnLattice(p), one_parity) << p.x << " " << p.y << " " << p.z;
  }
  constexpr int32_t kFar = 2 * kMaxExtentCells - 1;
  EXPECT_TRUE(IsOnLattice({kFar, kFar, kFar}));
  EXPECT_FALSE(IsOnLattice({kFar, kFar - 1, kFar}));
}

TEST(LatticePointLaw, SumsAndDifferencesOfLatticePointsAreLatticePoints) {
  for (LatticePoint p : CubeOfIntegers(-2, 2)) {
    for (LatticePoint q : CubeOfIntegers(-2, 2)) {
      if (!IsOnLattice(p) || !IsOnLattice(q)) continue;
      EXPECT_TRUE(IsOnLattice(p + q) && IsOnLattice(p - q) && IsOnLattice(-p));
      EXPECT_EQ(p + q - q, p);
    }
  }
}

TEST(LatticePoint, IsOrderedByZThenYThenX) {
  const std::vector<LatticePoint> cube = CubeOfIntegers(-1, 1);
  EXPECT_TRUE(std::ranges::is_sorted(cube));
  EXPECT_LT((LatticePoint{9, 9, 0}), (LatticePoint{0, 0, 1}));
  EXPECT_LT((LatticePoint{9, 0, 1}), (LatticePoint{0, 1, 1}));
}

TEST(Sublattice, CellsAndPointsCorrespond) {
  for (Sublattice s : kSublattices) {
    for (LatticePoint cell : CubeOfIntegers(-2, 3)) {
      const LatticePoint p = PointAt(s, cell.x, cell.y, cell.z);
      EXPECT_TRUE(IsOnLattice(p));
      EXPECT_EQ(SublatticeOf(p), s);
      EXPECT_EQ((LatticePoint{p.x >> 1, p.y >> 1, p.z >> 1}), cell);
    }
  }
}

TEST(LatticeExtent, ContainsAsManyPointsAsItCounts) {
  const LatticeExtent extent = {3, 2, 5};
  uint64_t points = 0;
  for (LatticePoint p : CubeOfIntegers(-3, 12)) {
    points += IsOnLattice(p) && extent.Contains(p) ? 1 : 0;
  }
  EXPECT_EQ(points, extent.PointCount());
  EXPECT_EQ(extent.PointCount(), 60u);
  constexpr LatticeExtent kLargest = {kMaxExtentCells, kMaxExtentCells, 1 << 18};
  EXPECT_EQ(kLargest.PointCount(), uint64_t{1} << 63) << "2 nx ny nz must not overflow here";
}

TEST(Directions, AreTheOffsetsOfLatticeNeighbors) {
  std::set<LatticePoint> diagonal, axial;
  for (LatticePoint d : CubeOfIntegers(-4, 4)) {
    if (!IsOnLattice(d)) continue;
    if (SumOfAbs(d) == 3) diagonal.insert(d);
    if (SumOfAbs(d) == 2) axial.insert(d);
  }
  const auto& all = kDirections14;
  EXPECT_EQ(std::set(all.begin(), all.begin() + 8), diagonal);
  EXPECT_EQ(std::set(all.begin() + 8, all.end()), axial);
}

TEST(Directions, AreTheShortestStepsOfTheLattice) {
  std::set<LatticePoint> near;
  for (LatticePoint d : CubeOfIntegers(-4, 4)) {
    if (IsOnLattice(d) && Dot(d, d) > 0 && Dot(d, d) <= 4) near.insert(d);
  }
  EXPECT_EQ(near, std::set(kDirections14.begin(), kDirections14.end()));
}

TEST(Directions, KeepTheirPublicBitOrder) {
  for (int bit = 0; bit < 8; ++bit) {
    const LatticePoint expected = {(bit & 1) != 0 ? 1 : -1, (bit & 2) != 0 ? 1 : -1,
                                   (bit & 4) != 0 ? 1 : -1};
    EXPECT_EQ(Direction(bit).offset(), expected);
    EXPECT_EQ(DiagonalDirection(bit).offset(), expected);
    EXPECT_TRUE(Direction(bit).is_diagonal());
  }
  const std::vector<LatticePoint> axial = {{2, 0, 0},  {-2, 0, 0}, {0, 2, 0},
                                           {0, -2, 0}, {0, 0, 2},  {0, 0, -2}};
  for (int n = 0; n < 6; ++n) {
    EXPECT_EQ(Direction(8 + n).offset(), axial[static_cast<size_t>(n)]);
    EXPECT_FALSE(Direction(8 + n).is_diagonal());
  }
}

TEST(Directions, DiagonalStepsChangeTheSublatticeAndAxialOnesKeepIt) {
  for (LatticePoint p : {LatticePoint{4, 6, 8}, LatticePoint{-3, 5, 1}}) {
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      const LatticePoint q = p + Direction(bit).offset();
      ASSERT_TRUE(IsOnLattice(q));
      EXPECT_EQ(SublatticeOf(p) != SublatticeOf(q), Direction(bit).is_diagonal());
    }
  }
}

TEST(Direction, OppositeTurnsItsOffsetAroundAndBack) {
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const Direction d(bit);
    EXPECT_EQ(d.Opposite().offset(), -d.offset());
    EXPECT_EQ(d.Opposite().Opposite(), d);
    EXPECT_NE(d.Opposite(), d);
  }
}

TEST(Direction, MasksAreOneBitEachAndFillTheNeighborhood) {
  NeighborMask all = 0;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    EXPECT_EQ(all & Direction(bit).mask(), 0);
    all = static_cast<NeighborMask>(all | Direction(bit).mask());
  }
  EXPECT_EQ(all, kAllNeighbors);
}

TEST(Direction, IsFoundByItsOffsetAlone) {
  int found = 0;
  for (LatticePoint offset : CubeOfIntegers(-3, 3)) {
    const std::optional<Direction> d = FindDirection(offset);
    if (!d) continue;
    ++found;
    EXPECT_EQ(d->offset(), offset);
  }
  EXPECT_EQ(found, kNeighborCount);
}

TEST(Placement, PutsTheDefaultLatticeAtHalfItsCoordinates) {
  EXPECT_EQ(Placement().ToWorld(LatticePoint{2, 4, 6}), (WorldPoint{1, 2, 3}));
  EXPECT_EQ(Placement().ToWorld(LatticePoint{1, 1, 1}), (WorldPoint{0.5, 0.5, 0.5}));
}

TEST(Placement, ScalesThenTurnsThenMoves) {
  const Placement placement = {.spacing = {2, 4, 8},
                               .origin = {100, 200, 300},
                               .direction = {0, -1, 0, 1, 0, 0, 0, 0, 1}};  // x to y, y to -x
  EXPECT_EQ(placement.ToWorld(LatticePoint{2, 0, 0}), (WorldPoint{100, 202, 300}));
  EXPECT_EQ(placement.ToWorld(LatticePoint{0, 2, 0}), (WorldPoint{96, 200, 300}));
  EXPECT_EQ(placement.ToWorld(LatticePoint{1, 1, 1}), (WorldPoint{98, 201, 304}));
  EXPECT_EQ(placement.ToWorld(0.5, 0, 0), (WorldPoint{100, 200.5, 300}));
}

}  // namespace
}  // namespace bccskel
