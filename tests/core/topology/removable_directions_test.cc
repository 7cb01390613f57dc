#include "core/topology/removable_directions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/core/topology/mask_symmetries.h"
#include "tests/support/reference_conditions.h"

namespace bccskel::removable_directions {
namespace {

constexpr int kMasks = 1 << kNeighborCount;

bool Has(NeighborMask mask, Direction n) { return (mask & n.mask()) != 0; }

// Conditions 1 to 4 without any table.
bool MeetsTheSixImplications(NeighborMask mask, DiagonalDirection d) {
  if (Has(mask, Direction(d).Opposite()) || !Has(mask, d)) return false;
  bool any_far = false;
  for (const Implication& arc : ImplicationsOf(d)) {
    if (Has(mask, arc.near) && !Has(mask, arc.far)) return false;
    any_far = any_far || Has(mask, arc.far);
  }
  return any_far;
}

// Written out by hand for one direction; the others follow by the symmetries of the cube.
TEST(RemovableDirections, RestOnTheseSixImplicationsForTheDirection111) {
  struct Arc {
    LatticePoint near, far;
  };
  const std::array<Arc, 6> arcs = {{{{-1, -1, 1}, {0, 0, 2}},
                                    {{-1, 1, -1}, {0, 2, 0}},
                                    {{1, -1, -1}, {2, 0, 0}},
                                    {{-2, 0, 0}, {-1, 1, 1}},
                                    {{0, -2, 0}, {1, -1, 1}},
                                    {{0, 0, -2}, {1, 1, -1}}}};
  const auto implications = ImplicationsOf(DiagonalDirection(7));
  for (const Arc& arc : arcs) {
    const Implication expected = {*FindDirection(arc.near), *FindDirection(arc.far)};
    EXPECT_EQ(std::ranges::count(implications, expected), 1);
  }
}

TEST(RemovableDirections, EqualConditions1To4ByFloodFill) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    for (int n = 0; n < kMasks; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      ASSERT_EQ(IsRemovable(mask, d), test::ReferenceIsRemovable(mask, d)) << n << " " << bit;
    }
  }
}

TEST(RemovableDirections, EqualTheSixImplicationsOnAllMasksAndDirections) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    for (int n = 0; n < kMasks; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      ASSERT_EQ(IsRemovable(mask, d), MeetsTheSixImplications(mask, d)) << n << " " << bit;
    }
  }
}

TEST(RemovableDirections, Condition1FollowsFromTheOtherThree) {
  for (int n = 0; n < kMasks; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    for (int bit = 0; bit < 8; ++bit) {
      const DiagonalDirection d(bit);
      if (IsDirectedBorderPoint(mask, d) && HasSequelPoint(mask, d) &&
          SatisfiesCheckingRings(mask, d)) {
        ASSERT_TRUE(IsSimple(mask)) << n << " " << bit;
      }
    }
  }
}

TEST(RemovableDirections, LeaveTheKnownNumberOfWordsAfterEachCondition) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    int border = 0, with_sequel = 0, with_rings = 0, all = 0;
    for (int n = 0; n < kMasks; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      if (!IsDirectedBorderPoint(mask, d) || !IsSimpleNonEnd(mask)) continue;
      ++border;
      with_sequel += HasSequelPoint(mask, d);
      with_rings += SatisfiesCheckingRings(mask, d);
      all += HasSequelPoint(mask, d) && SatisfiesCheckingRings(mask, d);
    }
    EXPECT_EQ(border, 3737);
    EXPECT_EQ(with_sequel, 2015);
    EXPECT_EQ(with_rings, 860);
    EXPECT_EQ(all, 728);
  }
}

TEST(RemovableDirections, CoverTheKnownNumbersOfWords) {
  std::array<int, 9> words_by_directions = {};
  std::array<int, 8> words_of_direction = {};
  for (int n = 0; n < kMasks; ++n) {
    const unsigned directions = RemovableDirections(static_cast<NeighborMask>(n));
    ++words_by_directions[static_cast<size_t>(std::popcount(directions))];
    for (size_t d = 0; d < 8; ++d) words_of_direction[d] += directions >> d & 1;
  }
  EXPECT_EQ(words_of_direction, (std::array<int, 8>{728, 728, 728, 728, 728, 728, 728, 728}));
  EXPECT_EQ(words_by_directions, (std::array<int, 9>{12216, 2912, 960, 192, 104, 0, 0, 0, 0}));
  EXPECT_EQ(kMasks - words_by_directions[0], 4168);
}

TEST(RemovableDirections, HaveThePublishedHash) {
  std::vector<uint8_t> bytes;
  for (int n = 0; n < kMasks; ++n)
    bytes.push_back(RemovableDirections(static_cast<NeighborMask>(n)));
  EXPECT_EQ(test::Fnv1a64(bytes), 0xd84d72ab98709991u);
}

TEST(RemovableDirections, MoveWithAll48SymmetriesOfTheCube) {
  for (const test::NeighborPermutation& symmetry : test::CubeSymmetries()) {
    for (int n = 0; n < kMasks; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      const NeighborMask moved = test::Permuted(RemovableDirections(mask), symmetry);
      ASSERT_EQ(RemovableDirections(test::Permuted(mask, symmetry)), moved) << n;
    }
  }
}

}  // namespace
}  // namespace bccskel::removable_directions
