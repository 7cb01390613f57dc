#include "core/topology/neighborhood.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/support/reference_conditions.h"

namespace bccskel {
namespace {

constexpr int kMasks = 1 << kNeighborCount;

NeighborMask Complement(int mask) { return static_cast<NeighborMask>(mask ^ kAllNeighbors); }

std::vector<LatticePoint> OffsetsIn(int mask) {
  std::vector<LatticePoint> offsets;
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    if ((mask >> bit & 1) != 0) offsets.push_back(Direction(bit).offset());
  }
  return offsets;
}

bool Adjacent(int a, int b) {
  return test::AreNeighbors(Direction(a).offset(), Direction(b).offset());
}

struct CliqueCounts {
  int pairs = 0;
  int triples = 0;

  friend bool operator==(const CliqueCounts&, const CliqueCounts&) = default;
};

// Adjacent pairs and triples of neighbors in the mask: together with the point itself, triangles
// and tetrahedra.
CliqueCounts CountCliques(int mask) {
  CliqueCounts counts;
  for (int a = 0; a < kNeighborCount; ++a) {
    for (int b = 0; b < a; ++b) {
      if ((mask >> a & mask >> b & 1) == 0 || !Adjacent(a, b)) continue;
      ++counts.pairs;
      for (int c = 0; c < b; ++c) {
        if ((mask >> c & 1) != 0 && Adjacent(a, c) && Adjacent(b, c)) ++counts.triples;
      }
    }
  }
  return counts;
}

TEST(Neighborhood, ClassifiesPointsByTheirNumberOfNeighbors) {
  EXPECT_TRUE(IsEndPoint(0b1000));
  EXPECT_TRUE(IsCurvePoint(0b1001));
  EXPECT_FALSE(IsEndPoint(0b1001));
  EXPECT_FALSE(IsCurvePoint(kAllNeighbors));
}

TEST(Neighborhood, SharesSixNeighborsAlongD8AndFourAlongD6) {
  for (int bit = 0; bit < kNeighborCount; ++bit) {
    const NeighborMask shared = NeighborsAmongN14(Direction(bit));
    EXPECT_EQ(NeighborsIn(shared), bit < 8 ? 6 : 4) << bit;
    for (int other = 0; other < kNeighborCount; ++other) {
      EXPECT_EQ((shared >> other & 1) != 0, Adjacent(bit, other)) << bit << " " << other;
    }
  }
}

TEST(Neighborhood, Has36TrianglesAnd24TetrahedraThroughEachPoint) {
  EXPECT_EQ(CountCliques(kAllNeighbors), (CliqueCounts{.pairs = 36, .triples = 24}));
}

TEST(Neighborhood, CountsComponentsLikeAFloodFillOnAll16384Masks) {
  for (int mask = 0; mask < kMasks; ++mask) {
    ASSERT_EQ(ComponentsIn(static_cast<NeighborMask>(mask)), test::CountComponents(OffsetsIn(mask)))
        << mask;
  }
}

TEST(Neighborhood, HasOneComponentIn11890Masks) {
  int object = 0, background = 0;
  for (int mask = 0; mask < kMasks; ++mask) {
    object += ComponentsIn(static_cast<NeighborMask>(mask)) == 1;
    background += ComponentsIn(Complement(mask)) == 1;
  }
  EXPECT_EQ(object, 11890);
  EXPECT_EQ(background, 11890);
}

TEST(Neighborhood, HasTheKnownNumbersOfIsthmuses) {
  int one_isthmus = 0, two_isthmus = 0, both = 0, isolated = 0, interior = 0;
  for (int mask = 0; mask < kMasks; ++mask) {
    const int object = ComponentsIn(static_cast<NeighborMask>(mask));
    const int background = ComponentsIn(Complement(mask));
    one_isthmus += object >= 2 && background == 1;
    two_isthmus += object == 1 && background >= 2;
    both += object >= 2 && background >= 2;
    isolated += object == 0;
    interior += background == 0;
  }
  EXPECT_EQ(one_isthmus, 4389);
  EXPECT_EQ(two_isthmus, 4389);
  EXPECT_EQ(both, 104);
  EXPECT_EQ(isolated, 1);
  EXPECT_EQ(interior, 1);
}

// The 14 neighbors triangulate a sphere, so the object part's loops are the background's
// components less one (Alexander duality): Condition 1 says that the link is contractible.
TEST(Neighborhood, EulerCharacteristicOfEveryLinkFollowsFromItsComponents) {
  for (int mask = 1; mask < kMasks - 1; ++mask) {
    const auto object = static_cast<NeighborMask>(mask);
    const CliqueCounts cliques = CountCliques(mask);
    const int euler = NeighborsIn(object) - cliques.pairs + cliques.triples;
    ASSERT_EQ(euler, ComponentsIn(object) - (ComponentsIn(Complement(mask)) - 1)) << mask;
  }
}

}  // namespace
}  // namespace bccskel
