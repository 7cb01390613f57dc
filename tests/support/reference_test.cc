#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <limits>
#include <vector>

#include "tests/core/topology/mask_symmetries.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_conditions.h"
#include "tests/support/reference_distance.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/reference_thinner.h"

// The oracles judge the product, so they are themselves checked against cases known by hand.

namespace bccskel::test {
namespace {

BettiNumbers BettiOf(std::vector<LatticePoint> points) {
  return ReferenceBetti(ReferencePointSet(points));
}

TEST(ReferenceBetti, KnowsSmallObjects) {
  EXPECT_EQ(BettiOf({}), (BettiNumbers{0, 0, 0}));
  EXPECT_EQ(BettiOf({{0, 0, 0}}), (BettiNumbers{1, 0, 0}));
  EXPECT_EQ(BettiOf({{0, 0, 0}, {4, 0, 0}}), (BettiNumbers{2, 0, 0}));
  const std::vector<LatticePoint> tetrahedron = {{0, 0, 0}, {2, 0, 0}, {1, 1, 1}, {1, -1, 1}};
  EXPECT_EQ(BettiOf(tetrahedron), (BettiNumbers{1, 0, 0}));
}

TEST(ReferenceBetti, CountsALoopAndACavity) {
  std::vector<LatticePoint> shell(kDirections14.begin(), kDirections14.end());
  EXPECT_EQ(BettiOf(shell), (BettiNumbers{1, 0, 1}));
  std::erase(shell, LatticePoint{0, 0, 2});
  std::erase(shell, LatticePoint{0, 0, -2});
  EXPECT_EQ(BettiOf(shell), (BettiNumbers{1, 1, 0}));
}

TEST(ReferenceConditions, LeaveTheKnownNumbersOfNeighborhoods) {
  for (int bit = 0; bit < 8; ++bit) {
    const DiagonalDirection d(bit);
    int simple = 0, with_sequel = 0, with_rings = 0, without_condition_1 = 0, all = 0;
    for (int n = 0; n <= kAllNeighbors; ++n) {
      const auto mask = static_cast<NeighborMask>(n);
      if (!ReferenceIsBorderPoint(mask, d) || !ReferenceCondition2(mask)) continue;
      const bool is_simple = ReferenceCondition1(mask), rings = ReferenceCondition3(mask, d);
      simple += is_simple;
      with_sequel += is_simple && ReferenceCondition4(mask, d);
      with_rings += is_simple && rings;
      without_condition_1 += rings && ReferenceCondition4(mask, d);
      all += ReferenceIsRemovable(mask, d);
    }
    EXPECT_EQ(simple, 3737);
    EXPECT_EQ(with_sequel, 2015);
    EXPECT_EQ(with_rings, 860);
    EXPECT_EQ(all, 728);
    EXPECT_EQ(without_condition_1, 728) << "Condition 1 follows from the others";
  }
}

TEST(ReferenceConditions, HaveThePublishedCountsAndHash) {
  std::array<int, 9> words_by_directions = {};
  std::vector<uint8_t> bytes;
  for (int n = 0; n <= kAllNeighbors; ++n) {
    bytes.push_back(ReferenceRemovableDirections(static_cast<NeighborMask>(n)));
    ++words_by_directions[static_cast<size_t>(std::popcount(bytes.back()))];
  }
  EXPECT_EQ(words_by_directions, (std::array<int, 9>{12216, 2912, 960, 192, 104, 0, 0, 0, 0}));
  EXPECT_EQ(Fnv1a64(bytes), 0xd84d72ab98709991u);
}

TEST(ReferenceDistance, TwoScansEqualTheMinimumOverAllBackgroundPoints) {
  const ReferencePointSet object(RandomBlob(3, {7, 7, 7}, 4, 6));
  const std::vector<uint32_t> counts = ReferenceChamfer(object);
  std::vector<LatticePoint> background;
  object.ForEachLatticePointOfBox([&](LatticePoint p) {
    if (!object.Contains(p)) background.push_back(p);
  });
  for (LatticePoint p : object.SortedPoints()) {
    uint32_t best = std::numeric_limits<uint32_t>::max();
    for (LatticePoint q : background) best = std::min(best, ReferenceChamferBetween(p, q));
    ASSERT_EQ(counts[object.Index(p)], best) << p.x << " " << p.y << " " << p.z;
  }
}

TEST(ReferenceDistance, RoundsToShellsAndNeverToShellZero) {
  EXPECT_EQ(ReferenceShell(181, 1), 2);   // 1.73 lattice units
  EXPECT_EQ(ReferenceShell(209, 1), 2);   // 2
  EXPECT_EQ(ReferenceShell(362, 1), 3);   // 3.46
  EXPECT_EQ(ReferenceShell(181, 2), 1);   // 0.87 cells
  EXPECT_EQ(ReferenceShell(181, 64), 1);  // would round to 0
}

TEST(ReferenceThinner, ReducesABallToOnePointAndARingToARing) {
  const Volume ball = VolumeOfPoints(RandomBlob(1, {9, 9, 9}, 1, 8));
  EXPECT_EQ(ReferenceBetti(ReferencePointSet(ReferenceThin(ball, {}))), (BettiNumbers{1, 0, 0}));
  std::vector<LatticePoint> ring = Translated(kDirections14, {2, 2, 2});
  std::erase(ring, LatticePoint{2, 2, 4});
  std::erase(ring, LatticePoint{2, 2, 0});
  const std::vector<LatticePoint> thin = ReferenceThin(VolumeOfPoints(ring), {});
  EXPECT_EQ(BettiOf(thin), (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(ReferenceSimpleNonEndPoints(ReferencePointSet(thin)), 0u);
}

TEST(ReferenceThinner, LeavesKeptPointsAndStopsAtTheLastShell) {
  const std::vector<LatticePoint> points = RandomBlob(5, {8, 8, 8}, 1, 8);
  const Volume ball = VolumeOfPoints(points);
  ThinningOptions keep_all, two_shells;
  keep_all.keep = points;
  two_shells.last_shell = 2;
  EXPECT_EQ(ReferenceThin(ball, keep_all).size(), points.size());
  const ReferenceThinning whole = ReferenceThinCounted(ball, {});
  const ReferenceThinning partial = ReferenceThinCounted(ball, two_shells);
  EXPECT_LT(partial.removed, whole.removed);
  EXPECT_EQ(partial.last_shell, whole.last_shell);
  EXPECT_EQ(partial.thin.size() + partial.removed + partial.removed_by_cleanup, points.size());
}

TEST(RandomObjects, AreTheSameForTheSameSeed) {
  EXPECT_EQ(RandomCloud(9, {5, 5, 5}, 0.5), RandomCloud(9, {5, 5, 5}, 0.5));
  EXPECT_NE(RandomCloud(9, {5, 5, 5}, 0.5), RandomCloud(10, {5, 5, 5}, 0.5));
  const double count = static_cast<double>(RandomCloud(1, {20, 20, 20}, 0.3).size());
  EXPECT_NEAR(count / 16000, 0.3, 0.02);
}

}  // namespace
}  // namespace bccskel::test
