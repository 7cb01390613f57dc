#include <gtest/gtest.h>

#include <vector>

#include "core/topology/neighborhood.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_point_set.h"

// Condition 6 in one parallel pass, in the paper's wording and as keep-2.

namespace bccskel {
namespace {

using StubbleRule = bool (*)(const test::ReferencePointSet&, LatticePoint);

std::vector<LatticePoint> AfterOnePass(const std::vector<LatticePoint>& points, StubbleRule rule) {
  const test::ReferencePointSet snapshot(points);
  test::ReferencePointSet object(points);
  for (LatticePoint p : points) {
    if (rule(snapshot, p)) object.Erase(p);
  }
  return object.SortedPoints();
}

const std::vector<LatticePoint> kFork = {{0, 0, 0},  {1, 1, 1},  {-1, -1, 1},
                                         {0, 0, -2}, {0, 0, -4}, {0, 0, -6}};
const std::vector<LatticePoint> kStar = {
    {0, 0, 0}, {1, 1, 1}, {-1, -1, 1}, {1, -1, -1}, {-1, 1, -1}};

TEST(Stubble, LiteralRuleTakesBothTinesOfAForkSoThatItsJunctionBecomesAnEnd) {
  const auto rest = AfterOnePass(kFork, test::ReferenceIsStubble);
  EXPECT_EQ(rest.size(), 4u);
  EXPECT_TRUE(IsEndPoint(test::ReferencePointSet(rest).NeighborsOf({0, 0, 0})));
}

TEST(Stubble, KeepTwoLeavesAForkOneTine) {
  const auto rest = AfterOnePass(kFork, test::ReferenceIsStubbleKeepTwo);
  EXPECT_EQ(rest.size(), 5u);
  EXPECT_TRUE(IsCurvePoint(test::ReferencePointSet(rest).NeighborsOf({0, 0, 0})));
}

TEST(Stubble, LiteralRuleTakesAllRaysOfAStar) {
  EXPECT_EQ(AfterOnePass(kStar, test::ReferenceIsStubble), (std::vector<LatticePoint>{{0, 0, 0}}));
}

TEST(Stubble, KeepTwoLeavesAStarTheTwoRaysOfHighestRank) {
  EXPECT_EQ(AfterOnePass(kStar, test::ReferenceIsStubbleKeepTwo),
            (std::vector<LatticePoint>{{0, 0, 0}, {-1, -1, 1}, {1, 1, 1}}));
}

TEST(Stubble, KeepsTheEndPointsOfACurve) {
  const std::vector<LatticePoint> curve = {{0, 0, 0}, {0, 0, 2}, {0, 0, 4}};
  EXPECT_EQ(AfterOnePass(curve, test::ReferenceIsStubble), curve);
  const std::vector<LatticePoint> pair = {{0, 0, 0}, {1, 1, 1}};
  EXPECT_EQ(AfterOnePass(pair, test::ReferenceIsStubble), pair);
}

// Why stubble may go in any pass: p is an end point with neighbor q only if q sees none of the
// neighbors that it shares with p. Then q is no simple point, so no rule takes it with p.
TEST(Stubble, ANeighborThatHasMoreThanTheEndPointIsNeitherSimpleNorAnEndPoint) {
  for (int n = 0; n < 1 << kNeighborCount; ++n) {
    const auto q = static_cast<NeighborMask>(n);
    for (int bit = 0; bit < kNeighborCount; ++bit) {
      const Direction p(bit);
      if ((q & p.mask()) == 0 || NeighborsIn(q) < 2) continue;
      if ((q & NeighborsAmongN14(p)) != 0) continue;
      ASSERT_FALSE(IsSimple(q) || IsEndPoint(q) || test::ReferenceRemovableDirections(q) != 0) << n;
    }
  }
}

// Removes, in one pass on one snapshot, all stubble points and all points removable along d.
TEST(StubbleLaw, GoesInTheSamePassAsConditions1To4WithoutChangingTheTopology) {
  for (uint64_t seed = 0; seed < 160; ++seed) {
    SCOPED_TRACE(seed);
    const DiagonalDirection d(static_cast<int>(seed % 8));
    const StubbleRule rule =
        seed % 16 < 8 ? test::ReferenceIsStubble : test::ReferenceIsStubbleKeepTwo;
    const auto points = test::RandomCloud(seed, {7, 7, 7}, 0.1 + 0.003 * static_cast<double>(seed));
    const auto candidates = test::RandomSubset(seed, points, 0.9);
    const test::ReferencePointSet snapshot(points);
    test::ReferencePointSet object(points);
    for (LatticePoint p : candidates) {
      if (rule(snapshot, p) || test::ReferenceIsRemovable(snapshot.NeighborsOf(p), d))
        object.Erase(p);
    }
    EXPECT_EQ(test::ReferenceBetti(object), test::ReferenceBetti(snapshot));
  }
}

// "The neighbor must not become an end point": by keep-2 alone every neighbor keeps two points.
TEST(StubbleLaw, KeepTwoMakesNoNewEndPointsWhenNothingElseGoes) {
  for (uint64_t seed = 0; seed < 40; ++seed) {
    SCOPED_TRACE(seed);
    const auto points = test::RandomCloud(seed, {8, 8, 8}, 0.15);
    const test::ReferencePointSet before(points);
    const auto rest = AfterOnePass(points, test::ReferenceIsStubbleKeepTwo);
    const test::ReferencePointSet after(rest);
    for (LatticePoint p : rest) {
      if (IsEndPoint(after.NeighborsOf(p))) {
        EXPECT_TRUE(IsEndPoint(before.NeighborsOf(p)));
      }
    }
  }
}

}  // namespace
}  // namespace bccskel
