#include "core/ranks/rank_topology.h"

#include <gtest/gtest.h>

#include <vector>

#include "core/import/shapes/shapes.h"
#include "core/volume/layer_part.h"
#include "tests/core/ranks/thread_exchange.h"
#include "tests/support/random_objects.h"

namespace bccskel {
namespace {

BettiNumbers OnRanks(const Volume& object, int ranks) {
  BettiNumbers betti;
  ranks::RunAsThreads(ranks, [&](ranks::Exchange& exchange) {
    const Volume part = OnlyLayers(object, {exchange.rank(), ranks});
    const auto bricks = ranks::AddGhosts(exchange, *ranks::ShareEvenly(exchange, part));
    const auto counted = ranks::CountBettiNumbersOverRanks(exchange, bricks, {});
    ASSERT_TRUE(counted.ok()) << counted.status();
    if (exchange.rank() == 0) betti = *counted;
  });
  return betti;
}

void ExpectSame(const Volume& object) {
  const BettiNumbers wanted = *CountBettiNumbers(object, {});
  for (const int ranks : {1, 2, 3, 5, 8}) EXPECT_EQ(OnRanks(object, ranks), wanted) << ranks;
}

// Far larger than a layer of bricks: they go on through many ranks.
TEST(RankTopology, LoopsAndCavitiesAcrossRanksAreCountedOnce) {
  for (const Shape shape : kShapes) {
    SCOPED_TRACE(ShapeName(shape));
    ExpectSame(*GenerateShape(shape, {.points = 300'000}));
    ExpectSame(*GenerateShape(shape, {.points = 100'000, .noise = 0.05}));
  }
}

TEST(RankTopology, DustFoamAndLayersAreAsOnOneMachine) {
  for (uint64_t seed = 0; seed < 3; ++seed) {
    for (const double share : {0.02, 0.3, 0.6, 0.95}) {
      ExpectSame(VolumeOfPoints(test::RandomCloud(seed, {50, 40, 60}, share)));
      ExpectSame(VolumeOfPoints(test::RandomCloud(seed, {60, 60, 3}, share)));
      ExpectSame(VolumeOfPoints(test::RandomCloud(seed, {3, 4, 200}, share)));
    }
  }
  ExpectSame(Volume::FromSortedBricks({9, 9, 90}, {}, {}, {}));
}

// The space between lies in layers without any brick.
TEST(RankTopology, EmptyLayersBetweenPartsAreOutside) {
  std::vector<LatticePoint> points = test::RandomCloud(1, {40, 40, 10}, 0.9);
  for (const LatticePoint p : test::RandomCloud(2, {40, 40, 10}, 0.9)) {
    points.push_back({p.x, p.y, p.z + 400});
  }
  ExpectSame(VolumeOfPoints(points));
}

}  // namespace
}  // namespace bccskel
