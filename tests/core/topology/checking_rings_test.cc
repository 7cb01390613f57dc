#include "core/topology/checking_rings.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "core/topology/neighborhood.h"
#include "tests/support/reference_conditions.h"

namespace bccskel {
namespace {

TEST(CheckingRings, AreSixRingsOfSixPoints) {
  const std::set<NeighborMask> distinct(CheckingRings().begin(), CheckingRings().end());
  EXPECT_EQ(distinct.size(), 6u);
  for (NeighborMask ring : CheckingRings()) {
    EXPECT_EQ(NeighborsIn(ring), 6);
    EXPECT_EQ(ComponentsIn(ring), 1);
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      if ((ring >> bit & 1) == 0) continue;
      EXPECT_EQ(NeighborsIn(NeighborsAmongN14(Direction(bit)) & ring), 2) << "a closed ring";
    }
  }
}

TEST(CheckingRings, AreThreePerDirectionSharedByOpposites) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    const auto through = CheckingRingsThrough(d);
    EXPECT_THAT(through, testing::UnorderedElementsAreArray(CheckingRingsThrough(d.Opposite())));
    int containing_d = 0;
    for (NeighborMask ring : CheckingRings()) containing_d += HasSequelPoint(ring, d);
    EXPECT_EQ(containing_d, 3);
    EXPECT_EQ((std::set<NeighborMask>(through.begin(), through.end())).size(), 3u);
  }
}

TEST(CheckingRings, AreThePlanesSpannedByAnAxialAndADiagonalDirection) {
  for (int d2 = 0; d2 < 8; ++d2) {
    std::set<NeighborMask> planes;
    for (int d1 = 8; d1 < kNeighborCount; ++d1) {
      planes.insert(test::ReferenceCheckingRing(Direction(d1).offset(), Direction(d2).offset()));
    }
    EXPECT_THAT(CheckingRingsThrough(DiagonalDirection(d2)),
                testing::UnorderedElementsAreArray(planes));
  }
}

TEST(CheckingRings, TwoDiagonalDirectionsSpanTheSameRings) {
  for (int a = 0; a < 8; ++a) {
    for (int b = 0; b < 8; ++b) {
      if (b == a || b == 7 - a) continue;
      EXPECT_THAT(CheckingRings(), testing::Contains(test::ReferenceCheckingRing(
                                       Direction(a).offset(), Direction(b).offset())));
    }
  }
}

TEST(CheckingRings, ConditionAgreesWithFloodFillOnAllMasksAndDirections) {
  for (int bit = 0; bit < 8; ++bit) {
    for (int n = 0; n < 1 << kNeighborCount; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      ASSERT_EQ(SatisfiesCheckingRings(mask, DiagonalDirection(bit)),
                test::ReferenceCondition3(mask, DiagonalDirection(bit)))
          << n;
    }
  }
}

}  // namespace
}  // namespace bccskel
