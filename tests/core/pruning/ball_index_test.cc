#include "core/pruning/ball_index.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "gtest/gtest.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

bool IsCoveredBySome(LatticePoint p, double way, const ThinSet& set,
                     const std::vector<LatticePoint>& points,
                     const std::vector<LatticePoint>& own) {
  return std::ranges::any_of(points, [&](LatticePoint q) {
    if (!set.Contains(q) || std::ranges::find(own, q) != own.end()) return false;
    return set.Between(p, q) < 0.9 * set.RadiusOf(q) && 2 * set.RadiusOf(q) < way;
  });
}

TEST(BallIndex, CoversWhatSomeBallOfAnotherBranchCovers) {
  std::mt19937 random(3);
  const Volume thin = VolumeOfPoints(test::RandomBlob(2, {30, 20, 20}, 2, 5));
  std::vector<LatticePoint> points = thin.SortedPoints();
  std::ranges::shuffle(points, random);
  std::vector<float> radii(points.size());
  for (float& radius : radii) {
    radius = std::exp2(std::uniform_real_distribution<float>(-1, 4)(random));
  }
  ThinSet set({thin, radii});
  BallIndex index(set, kIsotropic);
  size_t covered = 0;
  for (size_t n = 0; n + 20 < points.size(); n += 20) {
    const std::vector<LatticePoint> own(points.begin() + static_cast<std::ptrdiff_t>(n),
                                        points.begin() + static_cast<std::ptrdiff_t>(n + 20));
    index.SetOwn(own);
    for (const double way : {1.0, 3.0, 9.0, 40.0}) {
      const bool is_covered = index.IsCovered(own[0], way, set);
      ASSERT_EQ(is_covered, IsCoveredBySome(own[0], way, set, points, own)) << n << " " << way;
      covered += is_covered ? 1 : 0;
    }
    set.Remove(points[n + 20]);
  }
  EXPECT_GT(covered, 10U);
}

}  // namespace
}  // namespace bccskel
