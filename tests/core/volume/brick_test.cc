#include "core/volume/brick.h"

#include <gtest/gtest.h>

#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "core/lattice/directions.h"
#include "core/volume/brick_neighbors.h"
#include "core/volume/volume.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

TEST(BrickAddress, NamesEveryPointOfThreeBricksPerAxisOnce) {
  std::set<std::pair<uint64_t, int>> taken;
  for (Sublattice s : kSublattices) {
    for (int32_t k = 0; k < 3 * kBrickZ; ++k) {
      for (int32_t j = 0; j < 3 * kBrickY; ++j) {
        for (int32_t i = 0; i < 3 * kBrickX; ++i) {
          const LatticePoint p = PointAt(s, i, j, k);
          const BrickAddress address = AddressOf(p);
          ASSERT_TRUE(address.bit >= 0 && address.bit < kBrickPoints);
          ASSERT_EQ(PointOf(address.brick, address.bit), p);
          ASSERT_TRUE(taken.emplace(BrickKey(address.brick).value(), address.bit).second);
        }
      }
    }
  }
  EXPECT_EQ(taken.size(), size_t{2 * 27 * kBrickPoints});
}

// Boxes that hold the brick, miss it, end within it at even and odd places, or are empty.
TEST(BrickAddress, PointsInABoxAreThoseItContains) {
  std::mt19937 random(7);
  const auto near = [&](int32_t last) {
    return static_cast<int32_t>(random() % static_cast<uint32_t>(last + 9)) - 4;
  };
  for (int n = 0; n < 2000; ++n) {
    const BrickCoordinates brick = {1, 2, 1, kSublattices[random() % 2]};
    const LatticePoint first = BoxOf(brick).low, last = BoxOf(brick).high;
    const LatticePoint size = last - first;
    const auto corner = [&] {
      return LatticePoint{first.x + near(size.x), first.y + near(size.y), first.z + near(size.z)};
    };
    const LatticeBox box = {corner(), corner()};
    const BrickBits inside = PointsIn(brick, box);
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      ASSERT_EQ(inside.Test(bit), box.Contains(PointOf(brick, bit))) << n << ' ' << bit;
    }
  }
}

TEST(BrickAddress, LaysLanesAlongXLinesAlongYAndWordsAlongZ) {
  EXPECT_EQ(AddressOf({2 * 5, 0, 0}).bit, 5);
  EXPECT_EQ(AddressOf({0, 2 * 3, 0}).bit, 16 * 3);
  EXPECT_EQ(AddressOf({1, 1, 2 * 7 + 1}).bit, 64 * 7);
  EXPECT_EQ(AddressOf({2 * 16, 2 * 4, 2 * 8}).brick,
            (BrickCoordinates{1, 1, 1, Sublattice::kEven}));
}

std::vector<BrickCoordinates> BricksAround(std::vector<int32_t> steps) {
  std::vector<BrickCoordinates> bricks;
  for (int32_t bz : steps) {
    for (int32_t by : steps) {
      for (int32_t bx : steps) {
        for (Sublattice s : kSublattices) bricks.push_back({bx, by, bz, s});
      }
    }
  }
  return bricks;
}

TEST(BrickKey, HoldsCoordinatesFromTheBrickBelowZeroToTheLastOne) {
  constexpr int32_t kLast = kMaxExtentCells / kBrickY;  // the axis with the most bricks
  for (const BrickCoordinates& brick : BricksAround({-1, 0, 1, 77, kLast - 1, kLast})) {
    EXPECT_EQ(BrickKey(brick).coordinates(), brick);
  }
}

TEST(BrickKey, SortsLikeItsCoordinates) {
  const auto order = [](const BrickCoordinates& b) {
    return std::tuple(b.bz, b.by, b.bx, static_cast<int>(b.sublattice));
  };
  const auto bricks = BricksAround({-1, 0, 1, kMaxExtentCells / kBrickY});
  for (const auto& a : bricks) {
    for (const auto& b : bricks) {
      EXPECT_EQ(BrickKey(a) < BrickKey(b), order(a) < order(b));
    }
  }
}

TEST(BrickBits, SetClearCountAndVisitAgree) {
  BrickBits bits;
  std::set<int> expected;
  for (int n = 0; n < 200; ++n) {
    const int bit = n * n * 7 % kBrickPoints;
    bits.Set(bit);
    expected.insert(bit);
  }
  for (int bit : {0, 7, 511}) {
    bits.Clear(bit);
    expected.erase(bit);
  }
  std::vector<int> visited;
  bits.ForEachSetBit([&](int bit) { visited.push_back(bit); });
  EXPECT_EQ(visited, std::vector<int>(expected.begin(), expected.end()));
  EXPECT_EQ(bits.Count(), expected.size());
  for (int bit = 0; bit < kBrickPoints; ++bit) EXPECT_EQ(bits.Test(bit), expected.contains(bit));
  EXPECT_FALSE(bits.Empty());
  EXPECT_TRUE(BrickBits().Empty());
}

TEST(NeighborBrick, TogetherWithTheBrickHoldsTheNeighborsOfAllItsPoints) {
  for (Sublattice s : kSublattices) {
    const BrickCoordinates brick = {3, 4, 5, s};
    std::set<uint64_t> reached, named;
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      for (LatticePoint offset : kDirections14) {
        reached.insert(BrickKey(AddressOf(PointOf(brick, bit) + offset).brick).value());
      }
    }
    for (int position = 0; position < kNeighborCount; ++position) {
      named.insert(BrickKey(NeighborBrick(brick, position)).value());
    }
    EXPECT_EQ(named.size(), 14u);
    reached.erase(BrickKey(brick).value());
    EXPECT_EQ(reached, named);
  }
}

TEST(NeighborBrick, StandsWhereTheHeaderSays) {
  const BrickCoordinates even = {3, 4, 5, Sublattice::kEven}, odd = {3, 4, 5, Sublattice::kOdd};
  EXPECT_EQ(NeighborBrick(even, 0), odd);
  EXPECT_EQ(NeighborBrick(odd, 0), even);
  EXPECT_EQ(NeighborBrick(even, 5), (BrickCoordinates{2, 4, 4, Sublattice::kOdd}));
  EXPECT_EQ(NeighborBrick(odd, 5), (BrickCoordinates{4, 4, 6, Sublattice::kEven}));
  EXPECT_EQ(NeighborBrick(even, 8), (BrickCoordinates{4, 4, 5, Sublattice::kEven}));
  EXPECT_EQ(NeighborBrick(odd, 13), (BrickCoordinates{3, 4, 4, Sublattice::kOdd}));
}

TEST(BrickNeighborsLaw, AreWhatLookingEachOneUpFinds) {
  for (uint64_t seed = 0; seed < 8; ++seed) {
    const double density = seed < 4 ? 0.0005 : 0.01;  // few bricks, then nearly all of them
    const Volume volume = VolumeOfPoints(test::RandomCloud(seed, {100, 40, 60}, density));
    const auto neighbors = FindBrickNeighbors(volume.keys());
    ASSERT_EQ(neighbors.size(), volume.brick_count());
    size_t found = 0;
    for (size_t n = 0; n < neighbors.size(); ++n) {
      for (int position = 0; position < kNeighborCount; ++position) {
        const BrickKey key(NeighborBrick(volume.keys()[n].coordinates(), position));
        const auto expected = volume.Find(key);
        found += expected ? 1 : 0;
        ASSERT_EQ(neighbors[n][static_cast<size_t>(position)],
                  expected.value_or(static_cast<BrickIndex>(volume.brick_count())));
      }
    }
    EXPECT_GT(found, 0u);
  }
}

TEST(BrickNeighborsLaw, LeadEveryNeighborOfEveryPointToItsBit) {
  const Volume volume = VolumeOfPoints(test::RandomCloud(11, {50, 13, 25}, 0.05));
  const auto neighbors = FindBrickNeighbors(volume.keys());
  for (size_t n = 0; n < neighbors.size(); ++n) {
    const BrickCoordinates brick = volume.keys()[n].coordinates();
    volume.bricks()[n].ForEachSetBit([&](int bit) {
      for (LatticePoint offset : kDirections14) {
        const LatticePoint q = PointOf(brick, bit) + offset;
        const BrickAddress address = AddressOf(q);
        size_t at = n;
        for (int position = 0; position < kNeighborCount; ++position) {
          if (NeighborBrick(brick, position) == address.brick) {
            at = neighbors[n][static_cast<size_t>(position)];
          }
        }
        ASSERT_EQ(volume.padded_bricks()[at].Test(address.bit), volume.Contains(q));
      }
    });
  }
}

TEST(BrickNeighbors, OfNoBricksAreNone) { EXPECT_TRUE(FindBrickNeighbors({}).empty()); }

}  // namespace
}  // namespace bccskel
