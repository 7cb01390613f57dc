#include "core/prepare/join_gaps.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "core/certificate/certificate.h"
#include "core/exec/union_find.h"
#include "core/lattice/directions.h"
#include "core/pipeline/skeletonize.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/volume_where.h"

namespace bccskel {
namespace {

using test::VolumeWhere;

ChangedVolume Joined(const Volume& object, double gap, int threads = 1) {
  test::TeamContext context(threads);
  exec::UnlimitedMemory memory;
  auto joined = JoinGaps(object, gap, memory, context);
  EXPECT_TRUE(joined.ok()) << joined.status();
  return *std::move(joined);
}

// Balls of this radius on a line, with the given gaps between their nearest points.
Volume BallsInARow(double radius, const std::vector<double>& gaps) {
  std::vector<double> middles = {radius + 3};
  for (double gap : gaps) middles.push_back(middles.back() + 2 * radius + gap);
  const auto cells = static_cast<int32_t>((middles.back() + radius) / 2) + 3;
  const double middle = radius + 4;
  const auto wide = static_cast<int32_t>(middle) + 1;
  return VolumeWhere({cells, wide, wide}, [&](int32_t x, int32_t y, int32_t z) {
    return std::ranges::any_of(middles, [&](double at) {
      const double dx = x - at, dy = y - middle, dz = z - middle;
      return dx * dx + dy * dy + dz * dz <= radius * radius;
    });
  });
}

TEST(JoinGaps, JoinsWhatIsNearEnoughAndMakesNoLoops) {
  const Volume row = BallsInARow(7, {6, 9, 20});
  ASSERT_EQ(*CountBettiNumbers(row, {}), (BettiNumbers{4, 0, 0}));
  for (const auto& [gap, joined] : {std::pair(4.0, 0U), {8.0, 1U}, {12.0, 2U}, {24.0, 3U}}) {
    const ChangedVolume result = Joined(row, gap);
    EXPECT_EQ(result.count, joined) << gap;
    EXPECT_EQ(*CountBettiNumbers(result.object, {}), (BettiNumbers{4 - joined, 0, 0})) << gap;
    EXPECT_EQ(result.object.PointCount(), row.PointCount() + result.points_added);
    EXPECT_EQ(result.points_removed, 0u);
  }
}

// Three balls at the corners of a triangle get two bridges.
TEST(JoinGaps, DrawsAForest) {
  const auto ball = [](int32_t x, int32_t y, int32_t z, int32_t at_x, int32_t at_y) {
    const int32_t dx = x - at_x, dy = y - at_y, dz = z - 10;
    return dx * dx + dy * dy + dz * dz <= 49;
  };
  const Volume three = VolumeWhere({24, 24, 12}, [&](int32_t x, int32_t y, int32_t z) {
    return ball(x, y, z, 10, 10) || ball(x, y, z, 30, 10) || ball(x, y, z, 20, 29);
  });
  const ChangedVolume result = Joined(three, 20);
  EXPECT_EQ(result.count, 2u);
  EXPECT_EQ(*CountBettiNumbers(result.object, {}), (BettiNumbers{1, 0, 0}));
}

// How many sets the points are in if those at most `reach` apart are together.
int64_t SetsOf(const std::vector<LatticePoint>& points, double reach) {
  UnionFind<uint32_t> sets(points.size());
  auto count = static_cast<int64_t>(points.size());
  for (uint32_t a = 0; a < points.size(); ++a) {
    for (uint32_t b = 0; b < a; ++b) {
      const LatticePoint way = points[a] - points[b];
      if (Dot(way, way) > reach * reach || sets.Find(a) == sets.Find(b)) continue;
      sets.Unite(a, b);
      --count;
    }
  }
  return count;
}

TEST(JoinGaps, JoinsAllThatIsWithinTheGap) {
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Volume cloud = VolumeOfPoints(test::RandomCloud(seed, {14, 14, 14}, 0.02));
    std::vector<LatticePoint> points;
    cloud.ForEachPoint([&](LatticePoint p) { points.push_back(p); });
    const int64_t before = CountBettiNumbers(cloud, {})->components;
    for (double gap : {3.0, 5.0}) {
      const ChangedVolume result = Joined(cloud, gap);
      EXPECT_EQ(before - static_cast<int64_t>(result.count), SetsOf(points, gap)) << seed;
      EXPECT_LE(CountBettiNumbers(result.object, {})->components, SetsOf(points, gap)) << seed;
      EXPECT_EQ(Joined(cloud, gap, 3).object, result.object);
    }
  }
}

TEST(JoinGaps, LetsOneCurveRunThroughABrokenTube) {
  const Volume tube = VolumeWhere({70, 9, 9}, [](int32_t x, int32_t y, int32_t z) {
    const int32_t dy = y - 9, dz = z - 9;
    return dy * dy + dz * dz <= 20 && x > 6 && x < 134 && (x < 60 || x > 66);
  });
  SkeletonizeOptions options;
  options.preparing.join_gaps = 5 * WorldUnitsPerLatticeUnit(tube.placement());
  EXPECT_EQ(Skeletonize(tube, options, {})->graph.nodes.size(), 4u);
  options.preparing.join_gaps = 9 * WorldUnitsPerLatticeUnit(tube.placement());
  const auto result = Skeletonize(tube, options, {});
  ASSERT_TRUE(result.ok()) << result.status();
  EXPECT_EQ(result->graph.nodes.size(), 2u);
  EXPECT_EQ(result->graph.edges.size(), 1u);
}

}  // namespace
}  // namespace bccskel
