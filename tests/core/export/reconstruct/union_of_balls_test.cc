#include "core/export/reconstruct/union_of_balls.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/export/reconstruct/overlap.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr LatticeExtent kExtent = {40, 9, 11};
const Placement kFlat = {.spacing = {2, 2, 2}};
const Placement kUneven = {.spacing = {2, 1, 4}, .origin = {3, 2, 1}};

std::vector<LatticePoint> PointsIn(const std::vector<OpenBall>& balls, const Placement& placement) {
  const auto inside = [&](int32_t x, int32_t y, int32_t z) {
    return std::ranges::any_of(balls, [&](const OpenBall& ball) {
      const auto& [c, radius] = ball;
      const auto& [sx, sy, sz] = placement.spacing;
      return std::hypot((x - c[0]) * sx, (y - c[1]) * sy, (z - c[2]) * sz) / 2 < radius - 1e-4;
    });
  };
  return test::VolumeWhere(kExtent, inside).SortedPoints();
}

TEST(UnionOfBallsTest, HoldsThePointsNearerToACenterThanItsRadius) {
  const std::vector<OpenBall> cases[] = {
      {},
      {{{20, 8, 10}, 0.5}},
      {{{20, 8, 10}, std::sqrt(3.0)}},  // no neighbor is nearer
      {{{20, 8, 10}, 2}},
      {{{33.3, 8.2, 10.9}, 5.7}, {{60, 9, 3}, 4}},
      {{{-3, 20, -1}, 8}, {{79, 0, 21}, 30}},  // beyond the extent
  };
  for (const std::vector<OpenBall>& balls : cases) {
    for (const Placement& placement : {kFlat, kUneven}) {
      const auto volume = UnionOfBalls(balls, kExtent, placement, {});
      ASSERT_TRUE(volume.ok()) << volume.status();
      EXPECT_EQ(volume->SortedPoints(), PointsIn(balls, placement));
    }
  }
}

std::vector<LatticePoint> PointsOutside(const Volume& object, const Volume& balls) {
  std::vector<LatticePoint> outside;
  balls.ForEachPoint([&](LatticePoint p) {
    if (!object.Contains(p)) outside.push_back(p);
  });
  return outside;
}

TEST(UnionOfBallsLaw, TheBallsOfASkeletonHoldItAndLieInsideTheObject) {
  constexpr std::array<double, 3> kSpacings[] = {{1, 1, 3}, {0.3, 2, 0.7}, {5, 1, 1}, {1, 1, 1}};
  constexpr SkeletonKind kKinds[] = {SkeletonKind::kCurve, SkeletonKind::kSurface,
                                     SkeletonKind::kKernel};
  for (uint64_t seed = 0; seed < 24; ++seed) {
    SCOPED_TRACE(seed);
    const auto blob = test::RandomBlob(seed, {16, 14, 12}, 6, 9);
    const Volume object =
        test::VolumeWith(test::WithNoisyBoundary(seed, blob, 0.1), {30, 30, 30},
                         {.spacing = kSpacings[seed % 4], .origin = {-7, 2, 1e3}});
    SkeletonizeOptions options;
    options.thinning.kind = kKinds[seed % 3];
    const auto result = Skeletonize(object, options, {});
    ASSERT_TRUE(result.ok()) << result.status();
    const auto balls =
        UnionOfBalls(BallsOf(result->graph), object.extent(), object.placement(), {});
    ASSERT_TRUE(balls.ok()) << balls.status();
    EXPECT_THAT(PointsOutside(object, *balls), IsEmpty());
    EXPECT_THAT(PointsOutside(*balls, result->thin), IsEmpty());
  }
}

TEST(UnionOfBallsTest, APlaceInTheWorldFindsItsWayBack) {
  const Placement tilted = {.spacing = {1, 2, 0.5},
                            .origin = {10, -20, 5},
                            .direction = {0.6, -0.8, 0, 0.8, 0.6, 0, 0, 0, -1}};
  EXPECT_THAT(LatticePlaceOf(tilted.ToWorld(3, 5, -7), tilted),
              ElementsAre(DoubleNear(3, 1e-9), DoubleNear(5, 1e-9), DoubleNear(-7, 1e-9)));
}

TEST(OverlapTest, CountsWhatIsInBothAndWhatIsInEither) {
  const auto a = test::RandomCloud(1, {40, 9, 11}, 0.4), b = test::RandomCloud(2, {40, 9, 11}, 0.2);
  uint64_t common = 0;
  const Volume second = VolumeOfPoints(b);
  for (const LatticePoint p : a) common += second.Contains(p) ? 1u : 0u;
  const Overlap overlap = MeasureOverlap(VolumeOfPoints(a), second);
  EXPECT_EQ(overlap, (Overlap{common, a.size() + b.size() - common}));
  EXPECT_EQ(MeasureOverlap(second, second).Jaccard(), 1);
  EXPECT_EQ(MeasureOverlap(second, VolumeOfPoints({})).Jaccard(), 0);
}

}  // namespace
}  // namespace bccskel
