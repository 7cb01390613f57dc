#include "core/certificate/background_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bccskel {
namespace {

std::vector<BrickKey> KeysOf(std::vector<BrickCoordinates> bricks) {
  std::vector<BrickKey> keys;
  for (const BrickCoordinates& brick : bricks) keys.emplace_back(brick);
  std::ranges::sort(keys);
  return keys;
}

// All bricks of both sublattices with 0 <= bx, by, bz < 5 whose sublattice and coordinates pass.
template <typename Keep>
std::vector<BrickKey> BoxWith(Keep keep) {
  std::vector<BrickCoordinates> bricks;
  for (Sublattice s : kSublattices) {
    for (int n = 0; n < 125; ++n) {
      const BrickCoordinates brick = {n % 5, n / 5 % 5, n / 25, s};
      if (keep(brick)) bricks.push_back(brick);
    }
  }
  return KeysOf(bricks);
}

size_t NodeAt(const BackgroundGaps& gaps, BrickCoordinates missing) {
  size_t place = 0;
  return gaps.NodeAt(missing, place);
}

int64_t ComponentsOf(const std::vector<BrickKey>& keys) {
  const BackgroundGaps gaps(keys);
  constexpr size_t kFirstMember = 3;
  UnionFind<size_t> sets(kFirstMember + gaps.node_limit());
  GapPlaces places;
  int64_t components = gaps.node_count();
  for (size_t place = 0; place < gaps.place_count(); ++place) {
    components -= gaps.LinkGap(place, kFirstMember, places, sets);
  }
  return components;
}

bool IsInside(const BrickCoordinates& b, int32_t low, int32_t high) {
  const auto in = [&](int32_t v) { return v >= low && v <= high; };
  return in(b.bx) && in(b.by) && in(b.bz);
}

TEST(BackgroundGaps, WithoutBricksOnlyTheOutsideIsLeft) {
  EXPECT_EQ(ComponentsOf({}), 1);
  EXPECT_EQ(NodeAt(BackgroundGaps({}), {3, 4, 5, Sublattice::kOdd}), BackgroundGaps::kOutside);
}

TEST(BackgroundGaps, LieBetweenStoredBricksOfOneRowAndSublattice) {
  const auto keys = KeysOf({{2, 1, 1, Sublattice::kEven},
                            {4, 1, 1, Sublattice::kOdd},
                            {9, 1, 1, Sublattice::kEven},
                            {10, 1, 1, Sublattice::kEven}});
  const BackgroundGaps gaps(keys);
  EXPECT_EQ(gaps.node_count(), 2);
  const size_t gap = NodeAt(gaps, {3, 1, 1, Sublattice::kEven});
  EXPECT_NE(gap, BackgroundGaps::kOutside);
  EXPECT_EQ(NodeAt(gaps, {8, 1, 1, Sublattice::kEven}), gap);
  for (int32_t bx : {-1, 0, 1, 11, 30}) {
    EXPECT_EQ(NodeAt(gaps, {bx, 1, 1, Sublattice::kEven}), BackgroundGaps::kOutside);
  }
  EXPECT_EQ(NodeAt(gaps, {6, 1, 1, Sublattice::kOdd}), BackgroundGaps::kOutside);
  EXPECT_EQ(NodeAt(gaps, {6, 2, 1, Sublattice::kEven}), BackgroundGaps::kOutside);
  EXPECT_EQ(ComponentsOf(keys), 1) << "the gap is open to the rows above";
}

TEST(BackgroundGaps, AreFoundFromAnyStartingPlace) {
  const auto keys = BoxWith([](const auto& b) { return (b.bx + b.by * b.bz) % 3 != 0; });
  const BackgroundGaps gaps(keys);
  for (const BrickKey& key : BoxWith([](const auto& b) { return (b.bx + b.by * b.bz) % 3 == 0; })) {
    for (size_t start = 0; start <= keys.size() + 3; ++start) {
      size_t place = start;
      EXPECT_EQ(gaps.NodeAt(key.coordinates(), place), NodeAt(gaps, key.coordinates()));
    }
  }
}

TEST(BackgroundGaps, AHollowBoxOfBricksEnclosesOneComponent) {
  EXPECT_EQ(ComponentsOf(BoxWith([](const auto& b) { return !IsInside(b, 1, 3); })), 2);
  EXPECT_EQ(ComponentsOf(BoxWith([](const auto& b) { return !IsInside(b, 2, 2); })), 2);
}

TEST(BackgroundGaps, OneMissingBrickOfTheWallOpensIt) {
  for (Sublattice s : kSublattices) {
    const auto keys = BoxWith([s](const auto& b) {
      return !IsInside(b, 1, 3) && b != BrickCoordinates{2, 2, 0, s};
    });
    EXPECT_EQ(ComponentsOf(keys), 1);
  }
}

// The hole's bricks touch the one that is missing at the end of a row only across one step.
TEST(BackgroundGaps, AHoleIsOpenToTheOutsideOneStepAlongTheRow) {
  const auto walls_without = [](BrickCoordinates hole, BrickCoordinates opening) {
    return BoxWith([&](const auto& b) { return b != hole && b != opening; });
  };
  const auto odd = [](int32_t bx) { return BrickCoordinates{bx, 2, 2, Sublattice::kOdd}; };
  const auto even = [](int32_t bx) { return BrickCoordinates{bx, 2, 2, Sublattice::kEven}; };
  EXPECT_EQ(ComponentsOf(walls_without(odd(3), even(4))), 1);
  EXPECT_EQ(ComponentsOf(walls_without(even(1), odd(0))), 1);
  EXPECT_EQ(ComponentsOf(walls_without(odd(1), even(0))), 2);
  EXPECT_EQ(ComponentsOf(walls_without(even(3), odd(4))), 2);
}

TEST(BackgroundGaps, AnEvenAndAnOddBrickTouchAcrossACornerOneWayOnly) {
  const BrickCoordinates center = {2, 2, 2, Sublattice::kEven};
  const auto two_holes = [&](BrickCoordinates other) {
    return ComponentsOf(BoxWith([&](const auto& b) { return b != center && b != other; }));
  };
  EXPECT_EQ(two_holes({1, 1, 1, Sublattice::kOdd}), 2);
  EXPECT_EQ(two_holes({2, 2, 2, Sublattice::kOdd}), 2);
  EXPECT_EQ(two_holes({3, 3, 3, Sublattice::kOdd}), 3);
  EXPECT_EQ(two_holes({3, 3, 2, Sublattice::kEven}), 3);
}

}  // namespace
}  // namespace bccskel
