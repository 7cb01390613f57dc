#include "core/topology/simple_point_table.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/core/topology/mask_symmetries.h"
#include "tests/support/reference_conditions.h"

namespace bccskel::simple_point_table {
namespace {

constexpr int kMasks = 1 << kNeighborCount;

TEST(SimplePointTable, AgreesWithFloodFillOnAll16384Neighborhoods) {
  for (int n = 0; n < kMasks; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    ASSERT_EQ(IsSimple(mask), test::ReferenceCondition1(mask)) << n;
    ASSERT_EQ(IsSimpleNonEnd(mask),
              test::ReferenceCondition1(mask) && test::ReferenceCondition2(mask))
        << n;
  }
}

TEST(SimplePointTable, Has7500SimpleWordsByNumberOfNeighbors) {
  std::array<int, kNeighborCount + 1> simple = {};
  for (int n = 0; n < kMasks; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    simple[static_cast<size_t>(NeighborsIn(mask))] += IsSimple(mask);
  }
  EXPECT_EQ(simple, (std::array<int, kNeighborCount + 1>{0, 14, 36, 108, 304, 786, 1524, 1956, 1524,
                                                         786, 304, 108, 36, 14, 0}));
  int total = 0;
  for (int count : simple) total += count;
  EXPECT_EQ(total, 7500);
}

TEST(SimplePointTable, Has7486SimpleWordsThatAreNoEndPoints) {
  int count = 0;
  for (int n = 0; n < kMasks; ++n) count += IsSimpleNonEnd(static_cast<NeighborMask>(n));
  EXPECT_EQ(count, 7486);
}

TEST(SimplePointTable, IsTheSameForAMaskAndItsComplement) {
  for (int n = 0; n < kMasks; ++n) {
    ASSERT_EQ(IsSimple(static_cast<NeighborMask>(n)),
              IsSimple(static_cast<NeighborMask>(n ^ kAllNeighbors)));
  }
}

TEST(SimplePointTable, HasThePublishedHash) {
  std::vector<uint8_t> bytes;
  for (int n = 0; n < kMasks; ++n) bytes.push_back(IsSimple(static_cast<NeighborMask>(n)));
  EXPECT_EQ(test::Fnv1a64(bytes), 0x854d59676b787019u);
}

TEST(SimplePointTable, ObeysAll48SymmetriesOfTheCube) {
  for (const test::NeighborPermutation& symmetry : test::CubeSymmetries()) {
    for (int n = 0; n < kMasks; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      ASSERT_EQ(IsSimple(mask), IsSimple(test::Permuted(mask, symmetry))) << n;
    }
  }
}

TEST(SimplePointTable, Has554SymmetryClassesOf221SimpleOnes) {
  const auto symmetries = test::CubeSymmetries();
  ASSERT_EQ(symmetries.size(), 48u);
  int classes = 0, simple_classes = 0;
  for (int n = 0; n < kMasks; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    if (test::LeastImage(mask, symmetries) != mask) continue;
    ++classes;
    simple_classes += IsSimple(mask);
  }
  EXPECT_EQ(classes, 554);
  EXPECT_EQ(simple_classes, 221);
}

}  // namespace
}  // namespace bccskel::simple_point_table
