#include "core/pruning/ball_gaps.h"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "gtest/gtest.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::VolumeWhere;

// The curve of an object: points with radii, each alone.
ThinSet CurveOf(const Volume& object, const std::vector<BallGaps::Ball>& balls) {
  VolumeBuilder builder(object.extent(), object.placement());
  for (const BallGaps::Ball& ball : balls) builder.Add(ball.center);
  const Volume points = std::move(builder).Build().value();
  std::vector<float> radii;
  points.ForEachPoint([&](LatticePoint p) {
    radii.push_back(std::ranges::find(balls, p, &BallGaps::Ball::center)->radius);
  });
  return ThinSet({points, radii});
}

std::vector<BallGaps::Peak> PeaksOf(const Volume& object, const std::vector<BallGaps::Ball>& balls,
                                    int32_t edge) {
  const exec::Context context;
  StopPoll poll(context);
  return BallGaps(object, CurveOf(object, balls), edge, poll).Peaks(1, 0.1, poll);
}

double GapAt(LatticePoint p, const std::vector<BallGaps::Ball>& balls) {
  double least = std::numeric_limits<double>::infinity();
  for (const BallGaps::Ball& ball : balls) {
    least = std::min(least, StraightDistance(p, ball.center, kIsotropic) - ball.radius);
  }
  return least;
}

// The largest gap of all points of the object.
double LargestGap(const Volume& object, const std::vector<BallGaps::Ball>& balls) {
  double most = 0;
  object.ForEachPoint([&](LatticePoint p) { most = std::max(most, GapAt(p, balls)); });
  return most;
}

TEST(BallGaps, PeaksAreTheCornersOfABox) {
  const Volume box = VolumeWhere({64, 64, 64}, [](int32_t i, int32_t j, int32_t k) {
    return std::min({i, j, k}) >= 20 && std::max({i, j, k}) <= 108;
  });
  const std::vector<BallGaps::Ball> balls = {{{64, 64, 64}, 44}};
  for (const int32_t edge : {8, 16, 32}) {
    SCOPED_TRACE(edge);
    const std::vector<BallGaps::Peak> peaks = PeaksOf(box, balls, edge);
    EXPECT_EQ(peaks.size(), 8U);
    for (const BallGaps::Peak& peak : peaks) {
      EXPECT_EQ(peak.ball, balls[0]);
      EXPECT_EQ(peak.gap, LargestGap(box, balls));
      for (const int32_t c : {peak.tip.x, peak.tip.y, peak.tip.z}) {
        EXPECT_TRUE(c == 20 || c == 108) << c;
      }
    }
  }
}

TEST(BallGaps, TakeTheNearestOfManyBalls) {
  const Volume box = VolumeWhere({80, 40, 40}, [](int32_t i, int32_t j, int32_t k) {
    return std::min({i, j, k}) >= 10 && i <= 150 && std::max(j, k) <= 70;
  });
  std::vector<BallGaps::Ball> balls;
  for (int32_t x = 40; x <= 120; x += 4) balls.push_back({{x, 40, 40}, 30});
  for (const int32_t edge : {8, 16}) {
    SCOPED_TRACE(edge);
    double most = 0;
    for (const BallGaps::Peak& peak : PeaksOf(box, balls, edge)) {
      EXPECT_TRUE(box.Contains(peak.tip));
      // The nearest ball of a cube need not be that of all its points.
      EXPECT_GE(peak.gap, GapAt(peak.tip, balls));
      EXPECT_LT(peak.gap, GapAt(peak.tip, balls) + edge / 2);
      most = std::max(most, GapAt(peak.tip, balls));
    }
    EXPECT_EQ(most, LargestGap(box, balls));
  }
}

// A ball beside a gap of the object is nearer, but the way to it is not.
TEST(BallGaps, BallsAcrossAGapDoNotCount) {
  const Volume bars = VolumeWhere({64, 64, 16}, [](int32_t i, int32_t j, int32_t) {
    return (j >= 8 && j <= 40 && i >= 8 && i <= 120) || (j >= 64 && j <= 90 && i >= 8 && i <= 60);
  });
  const std::vector<BallGaps::Ball> balls = {{{32, 24, 16}, 16}, {{50, 76, 16}, 14}};
  const std::vector<BallGaps::Peak> peaks = PeaksOf(bars, balls, 8);
  const auto is_end = [](const BallGaps::Peak& peak) { return peak.tip.x == 120; };
  const auto end = std::ranges::find_if(peaks, is_end);
  ASSERT_NE(end, peaks.end());
  EXPECT_EQ(end->ball, balls[0]);
}

}  // namespace
}  // namespace bccskel
