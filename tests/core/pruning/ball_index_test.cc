#include "core/pruning/ball_index.h"

#include <algorithm>
#include <iterator>
#include <limits>
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
  // Distances to some of the points, as if they were background.
  std::vector<LatticePoint> background;
  std::ranges::sample(points, std::back_inserter(background), 8, random);
  const auto radius_at = [&](LatticePoint p) {
    double least = std::numeric_limits<double>::infinity();
    for (LatticePoint q : background) least = std::min(least, StraightDistance(p, q, kIsotropic));
    return static_cast<float>(least);
  };
  std::vector<float> radii;
  for (LatticePoint p : points) radii.push_back(radius_at(p));
  ThinSet set({thin, radii});
  std::ranges::shuffle(points, random);
  BallIndex index(set);
  size_t covered = 0;
  for (size_t n = 0; n + 20 < points.size(); n += 20) {
    const std::vector<LatticePoint> own(points.begin() + static_cast<std::ptrdiff_t>(n),
                                        points.begin() + static_cast<std::ptrdiff_t>(n + 20));
    index.SetOwn(own);
    for (const double way : {1.0, 3.0, 9.0, 40.0}) {
      const bool is_covered = index.IsCovered(own[0], radius_at(own[0]), way, set);
      ASSERT_EQ(is_covered, IsCoveredBySome(own[0], way, set, points, own)) << n << " " << way;
      covered += is_covered ? 1 : 0;
    }
    set.Remove(points[n + 20]);
  }
  EXPECT_GT(covered, 10U);
}

}  // namespace
}  // namespace bccskel
