#include <gtest/gtest.h>

#include <utility>

#include "core/topology/neighborhood.h"
#include "tests/support/reference_conditions.h"

// What else the 14 neighbors say of a point, counted over all neighborhoods.

namespace bccskel {
namespace {

// Components of object and of background neighbors.
using Counts = std::pair<int, int>;

Counts CountsOf(NeighborMask mask) {
  return {ComponentsIn(mask), ComponentsIn(static_cast<NeighborMask>(mask ^ kAllNeighbors))};
}

int64_t EulerCharacteristicOf(NeighborMask mask) {
  int edges = 0, triangles = 0;  // counted from each of their ends
  for (int a = 0; a < kNeighborCount; ++a) {
    if ((mask >> a & 1) == 0) continue;
    const auto around = static_cast<NeighborMask>(NeighborsAmongN14(Direction(a)) & mask);
    edges += NeighborsIn(around);
    for (int b = 0; b < kNeighborCount; ++b) {
      if ((around >> b & 1) == 0) continue;
      triangles += NeighborsIn(around & NeighborsAmongN14(Direction(b)));
    }
  }
  return NeighborsIn(mask) - edges / 2 + triangles / 6;
}

TEST(Isthmus, EveryNeighborhoodIsOfOneClass) {
  int simple = 0, one = 0, two = 0, both = 0, isolated = 0, interior = 0;
  for (int n = 0; n < 1 << kNeighborCount; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    const auto [object, background] = CountsOf(mask);
    simple += IsSimple(mask);
    one += test::ReferenceIsOneIsthmus(mask);
    two += test::ReferenceIsTwoIsthmus(mask);
    both += object >= 2 && background >= 2;
    isolated += object == 0;
    interior += background == 0;
  }
  EXPECT_EQ(simple, 7500);
  EXPECT_EQ(one, 4389);
  EXPECT_EQ(two, 4389);
  EXPECT_EQ(both, 104);
  EXPECT_EQ(isolated, 1);
  EXPECT_EQ(interior, 1);
  EXPECT_EQ(simple + one + two + both + isolated + interior, 1 << kNeighborCount);
}

// Why one number tells the classes apart, but for the neighborhoods with two and two components.
TEST(Isthmus, TheEulerCharacteristicIsOneMoreThanTheDifferenceOfComponents) {
  for (int n = 0; n < 1 << kNeighborCount; ++n) {
    const auto mask = static_cast<NeighborMask>(n);
    const auto [object, background] = CountsOf(mask);
    const int64_t characteristic = EulerCharacteristicOf(mask);
    EXPECT_GE(characteristic, -4);
    EXPECT_LE(characteristic, 6);
    if (object == 0 || background == 0) {
      EXPECT_EQ(characteristic, object == 0 ? 0 : 2);
    } else {
      EXPECT_EQ(characteristic, object - background + 1);
    }
    if (object >= 2 && background >= 2) {
      EXPECT_EQ(CountsOf(mask), (Counts{2, 2}));
    }
  }
}

}  // namespace
}  // namespace bccskel
