#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "core/certificate/certificate.h"
#include "core/exec/instruction_sets.h"
#include "tests/support/contexts.h"
#include "tests/support/random_objects.h"
#include "tests/support/reference_betti.h"
#include "tests/support/reference_point_set.h"
#include "tests/support/sanitized.h"
#include "tests/support/volume_where.h"

namespace bccskel {

void PrintTo(const BettiNumbers& b, std::ostream* out) {
  *out << "{" << b.components << ", " << b.loops << ", " << b.cavities << "}";
}

namespace {

using test::RandomBlob;
using test::RandomCloud;
using test::ReferenceBetti;
using test::ReferencePointSet;
using test::VolumeWhere;

BettiNumbers Betti(const Volume& object, int threads = 1) {
  test::TeamContext context(threads);
  return CountBettiNumbers(object, context).value();
}
BettiNumbers Betti(const std::vector<LatticePoint>& points) {
  return Betti(VolumeOfPoints(points));
}

// One character per radius: shells around (c, c, c), `thickness` thick, of the given outer radii.
Volume Matryoshka(double c, const std::vector<double>& radii, double thickness) {
  const auto cells = static_cast<int32_t>(c) + 2;
  return VolumeWhere({cells, cells, cells}, [&](double x, double y, double z) {
    const double r = std::hypot(x - c, y - c, z - c);
    return std::ranges::any_of(radii,
                               [&](double outer) { return r <= outer && r > outer - thickness; });
  });
}

TEST(BettiNumbers, OfNothingAreZero) { EXPECT_EQ(Betti(Volume()), (BettiNumbers{0, 0, 0})); }

TEST(BettiNumbers, OfThreeMutuallyAdjacentPointsHaveNoLoop) {
  EXPECT_EQ(Betti({{4, 4, 4}, {5, 5, 5}, {6, 4, 4}}), (BettiNumbers{1, 0, 0}));
}

TEST(BettiNumbers, OfAHexagonHaveOneLoop) {
  EXPECT_EQ(Betti({{6, 8, 8}, {7, 7, 9}, {8, 6, 8}, {9, 7, 7}, {8, 8, 6}, {7, 9, 7}}),
            (BettiNumbers{1, 1, 0}));
}

TEST(BettiNumbersLaw, AgreeWithFloodFillOnRandomCloudsOfAllDensities) {
  for (uint64_t seed = 0; seed < 200; seed += test::kStride) {
    const double density = static_cast<double>(seed % 50 + 1) / 50.0;
    const auto points = RandomCloud(seed, {18, 9, 10}, density);
    ASSERT_EQ(Betti(points), ReferenceBetti(ReferencePointSet(points))) << "seed " << seed;
  }
}

TEST(BettiNumbersLaw, AgreeWithFloodFillOnBlobsWithNoisyBorders) {
  for (uint64_t seed = 0; seed < 12; seed += test::kStride) {
    const auto blob = RandomBlob(seed, {40, 40, 40}, 12, 16);
    const auto points = test::WithNoisyBoundary(seed, blob, 0.1);
    ASSERT_EQ(Betti(points), ReferenceBetti(ReferencePointSet(points))) << "seed " << seed;
  }
}

// Sparse bricks far apart: gaps, empty rows and the outside.
TEST(BettiNumbersLaw, AgreeWithFloodFillOnHollowBlobs) {
  for (uint64_t seed = 0; seed < 12; seed += test::kStride) {
    const auto blob = RandomBlob(seed + 50, {60, 60, 60}, 3, 60);
    const ReferencePointSet solid(blob);
    std::vector<LatticePoint> border;
    for (LatticePoint p : blob) {
      if (solid.NeighborsOf(p) != kAllNeighbors) border.push_back(p);
    }
    ASSERT_EQ(Betti(border), ReferenceBetti(ReferencePointSet(border))) << "seed " << seed;
    const auto holed = test::RandomSubset(seed, border, 0.97);
    ASSERT_EQ(Betti(holed), ReferenceBetti(ReferencePointSet(holed))) << "seed " << seed;
  }
}

TEST(BettiNumbers, OfAHollowBallWithMissingBricksInsideCountTheCavity) {
  const Volume ball = Matryoshka(120, {118}, 5);
  const LatticePoint center = {120, 120, 120};
  ASSERT_FALSE(ball.Find(BrickKey(AddressOf(center).brick)).has_value());
  EXPECT_EQ(Betti(ball), (BettiNumbers{1, 0, 1}));
}

TEST(BettiNumbers, OfAPiercedHollowBallHaveNoCavity) {
  VolumeBuilder builder({122, 122, 122});
  Matryoshka(120, {118}, 5).ForEachPoint([&](LatticePoint p) {
    if (std::abs(p.x - 120) + std::abs(p.y - 120) > 5 || p.z > 120) builder.Add(p);
  });
  EXPECT_EQ(Betti(*std::move(builder).Build()), (BettiNumbers{1, 0, 0}));
}

// A hollow box of full bricks, with or without one column of points bored through a single brick:
// that brick alone links the missing bricks inside to those outside.
TEST(BettiNumbers, OfAHollowBoxOpenedByOneColumnOfOneBrickHaveNoCavity) {
  for (Sublattice sublattice : kSublattices) {
    VolumeBuilder builder({5 * kBrickX, 5 * kBrickY, 5 * kBrickZ});
    for (int n = 0; n < 250; ++n) {
      const BrickCoordinates brick = {n % 5, n / 5 % 5, n / 25 % 5, kSublattices[n < 125 ? 0 : 1]};
      const bool inside = brick.bx % 4 != 0 && brick.by % 4 != 0 && brick.bz % 4 != 0;
      if (!inside) builder.Brick(BrickKey(brick)).words.fill(~uint64_t{0});
    }
    EXPECT_EQ(Betti(VolumeBuilder(builder).Build().value()), (BettiNumbers{1, 0, 1}));
    for (int k = 0; k < kBrickZ; ++k) {
      builder.Remove(PointOf({2, 2, 0, sublattice}, 64 * k + 16 + 5));
    }
    EXPECT_EQ(Betti(std::move(builder).Build().value()), (BettiNumbers{1, 0, 0}));
  }
}

TEST(BettiNumbers, OfAMatryoshkaCountEachDollAndEachCavity) {
  EXPECT_EQ(Betti(Matryoshka(120, {118, 90, 60, 30}, 6)), (BettiNumbers{4, 0, 4}));
  EXPECT_EQ(Betti(Matryoshka(120, {118, 90, 60, 30, 5}, 6)), (BettiNumbers{5, 0, 4}));
}

TEST(BettiNumbers, OfATorusAndOfItsShell) {
  const auto torus = [](double x, double y, double z, double r) {
    return std::hypot(std::hypot(x - 60, y - 60) - 35, z - 24) <= r;
  };
  EXPECT_EQ(
      Betti(VolumeWhere({60, 60, 24}, [&](auto x, auto y, auto z) { return torus(x, y, z, 18); })),
      (BettiNumbers{1, 1, 0}));
  EXPECT_EQ(Betti(VolumeWhere(
                {60, 60, 24},
                [&](auto x, auto y, auto z) { return torus(x, y, z, 18) && !torus(x, y, z, 14); })),
            (BettiNumbers{1, 2, 1}));
}

TEST(BettiNumbers, OfAKnotAreOneComponentAndOneLoop) {
  VolumeBuilder builder({80, 80, 60});
  for (int step = 0; step < 3000; ++step) {
    const double t = step * 2 * M_PI / 3000;
    const double r = 40 + 16 * std::cos(3 * t);
    const double cx = 80 + r * std::cos(2 * t), cy = 80 + r * std::sin(2 * t);
    const double cz = 60 + 30 * std::sin(3 * t);
    for (int n = 0; n < 11 * 11 * 11; ++n) {
      const LatticePoint p = {static_cast<int32_t>(cx) + n % 11 - 5,
                              static_cast<int32_t>(cy) + n / 11 % 11 - 5,
                              static_cast<int32_t>(cz) + n / 121 - 5};
      if (std::hypot(p.x - cx, p.y - cy, p.z - cz) <= 4) builder.Add(p);
    }
  }
  EXPECT_EQ(Betti(*std::move(builder).Build()), (BettiNumbers{1, 1, 0}));
}

TEST(BettiNumbersLaw, DoNotChangeWhenTheObjectMovesAcrossBricks) {
  const auto points = RandomCloud(7, {9, 7, 7}, 0.35);
  const BettiNumbers expected = ReferenceBetti(ReferencePointSet(points));
  for (int32_t shift = 0; shift <= 34; shift += test::kStride) {
    for (LatticePoint unit : {LatticePoint{2, 0, 0}, {0, 2, 0}, {0, 0, 2}, {1, 1, 1}}) {
      const LatticePoint by = {unit.x * shift, unit.y * shift, unit.z * shift};
      ASSERT_EQ(Betti(test::Translated(points, by)), expected) << "shift " << shift;
    }
  }
}

TEST(BettiNumbersLaw, AreTheSameForAnyNumberOfThreads) {
  const std::vector<Volume> objects = {VolumeOfPoints(RandomCloud(3, {64, 40, 40}, 0.25)),
                                       VolumeOfPoints(RandomCloud(4, {64, 40, 40}, 0.8)),
                                       Matryoshka(60, {58, 40, 20}, 4)};
  for (const Volume& object : objects) {
    const BettiNumbers expected = Betti(object, 1);
    for (int threads : {2, 3, 8}) EXPECT_EQ(Betti(object, threads), expected);
  }
}

TEST(BettiNumbersLaw, AreTheSameOnAnyInstructionSet) {
  for (uint64_t seed = 0; seed < 8; seed += test::kStride) {
    const auto blob = RandomBlob(seed, {40, 20, 20}, 6, 14);
    const Volume noisy = VolumeOfPoints(test::WithNoisyBoundary(seed, blob, 0.3));
    const Volume cloud =
        VolumeOfPoints(RandomCloud(seed, {40, 20, 20}, 0.1 + 0.1 * static_cast<double>(seed)));
    for (const Volume* object : {&noisy, &cloud}) {
      const BettiNumbers expected = ReferenceBetti(ReferencePointSet(*object));
      for (const std::string& name : exec::SupportedInstructionSets()) {
        ASSERT_TRUE(exec::ChooseInstructionSet(name));
        EXPECT_EQ(Betti(*object), expected) << name << ", seed " << seed;
      }
      exec::ChooseInstructionSet("");
    }
  }
}

TEST(BettiNumbers, StopWhenTheJobIsCancelledOrLate) {
  const Volume object = VolumeOfPoints(RandomCloud(3, {20, 20, 20}, 0.5));
  const exec::Context context = test::Stopped();
  EXPECT_EQ(CountBettiNumbers(object, context).status().code(), absl::StatusCode::kCancelled);
  const exec::Context late = test::Late();
  EXPECT_EQ(CountBettiNumbers(object, late).status().code(), absl::StatusCode::kDeadlineExceeded);
}

}  // namespace
}  // namespace bccskel
