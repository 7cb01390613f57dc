#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "core/import/shapes/figures.h"
#include "core/pipeline/skeletonize.h"
#include "core/skeleton/skeleton_figures.h"
#include "tests/core/pruning/simple_noise.h"
#include "tests/support/random_network.h"

namespace bccskel {
namespace {

using shapes::RoundCone;
using shapes::Solid;

Volume ObjectOf(const std::vector<Solid>& solids, double noise, uint64_t points) {
  const Volume object = *shapes::GenerateFigure(solids, {.points = points});
  return noise == 0 ? object : test::WithSimpleNoise(object, noise, 1);
}

ComponentFigures FiguresOf(const std::vector<Solid>& solids, double noise = 0,
                           uint64_t points = 150'000) {
  const auto result = Skeletonize(ObjectOf(solids, noise, points), {}, {});
  EXPECT_TRUE(result.ok()) << result.status();
  const ComponentFigures total = TotalOf(ComponentsOf(result->graph));
  EXPECT_EQ(static_cast<int64_t>(total.loops), result->certificate.skeleton.loops);
  return total;
}

// To 5 %, over networks of these seeds.
void ExpectTrueJunctions(uint64_t points, const std::vector<uint64_t>& seeds, double noise) {
  int64_t found = 0, true_ones = 0;
  for (const uint64_t seed : seeds) {
    const test::Network network = test::RandomNetwork(seed);
    found += static_cast<int64_t>(FiguresOf(network.Solids(), noise, points).junctions);
    true_ones += network.Junctions();
  }
  EXPECT_LE(20 * std::abs(found - true_ones), true_ones)
      << found << " for " << true_ones << " with noise " << noise;
}

// 40 and more junctions for 20 nodes as long as those of degree 4 and 5 were several.
TEST(Junctions, OfARandomNetworkAreItsNodes) {
  for (const double noise : {0.0, 0.05}) ExpectTrueJunctions(150'000, {301, 302, 303}, noise);
}

// At 100,000 points tubes are three units thick, and sampling moves junctions by a third of that.
TEST(Junctions, OfThinTubesAreTheNodes) {
  ExpectTrueJunctions(100'000, {311, 312, 313, 314, 315, 316}, 0.1);
}

TEST(Junctions, OfLimbsThreeRadiiApartStayApart) {
  std::vector<Solid> limbs = {RoundCone{{-14, 0, 0}, {14, 0, 0}, 1, 1}};
  for (int n = 0; n < 6; ++n) {
    const double x = 3 * n - 7.5, way = n % 2 == 0 ? 7 : -7;
    limbs.push_back(RoundCone{{x, 0, 0}, {x, way, 0}, 0.7, 0.7});
  }
  for (const double noise : {0.0, 0.05}) {
    const ComponentFigures figures = FiguresOf(limbs, noise);
    EXPECT_EQ(figures.junctions, 6u);
    EXPECT_EQ(figures.ends, 8u);
  }
}

// Rungs between two rails as close as they can be.
TEST(Junctions, OfParallelTubesStayApart) {
  std::vector<Solid> ladder = {RoundCone{{-12, 1.3, 0}, {12, 1.3, 0}, 1, 1},
                               RoundCone{{-12, -1.3, 0}, {12, -1.3, 0}, 1, 1}};
  for (const double x : {-6.0, 0.0, 6.0}) {
    ladder.push_back(RoundCone{{x, -1.3, 0}, {x, 1.3, 0}, 0.8, 0.8});
  }
  const ComponentFigures figures = FiguresOf(ladder);
  EXPECT_EQ(figures.junctions, 6u);
  EXPECT_EQ(figures.loops, 2u);
}

}  // namespace
}  // namespace bccskel
