#include "core/pruning/firm_depth.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/exec/instruction_sets.h"
#include "core/prepare/brick_sets.h"
#include "core/prepare/denoise.h"
#include "tests/support/random_objects.h"
#include "tests/support/sanitized.h"

namespace bccskel {
namespace {

Volume Placed(const std::vector<LatticePoint>& points, const std::array<double, 3>& spacing) {
  VolumeBuilder builder({80, 80, 80}, {.spacing = spacing});
  for (LatticePoint p : points) builder.Add(p);
  return *std::move(builder).Build();
}

Volume WithoutPits(const Volume& object) { return Union(object, Denoise(object, {})->object); }

// Asks for some object points, one after the other.
void ExpectDepths(const Volume& object, const ExactRadius& radius) {
  const Volume filled = WithoutPits(object);
  ExactRadius expected(filled);
  FirmDepth depth(object, radius);
  size_t n = 0;
  object.ForEachPoint([&](LatticePoint p) {
    if (n++ % 3 != 0) return;
    ASSERT_GE(depth.AtMost(p), expected.At(p));
    ASSERT_EQ(depth.At(p), expected.At(p));
    ASSERT_EQ(depth.AtMost(p), expected.At(p)) << "is known by now";
  });
}

class FirmDepthLaw : public testing::TestWithParam<uint64_t> {};

TEST_P(FirmDepthLaw, IsTheDistanceToTheBackgroundOfTheObjectWithoutPits) {
  const uint64_t seed = GetParam();
  const std::vector<LatticePoint> blob = test::RandomBlob(seed, {50, 30, 30}, 4, 25);
  for (const auto& points :
       {blob, test::WithNoisyBoundary(seed, blob, 0.02), test::WithNoisyBoundary(seed, blob, 0.3),
        test::RandomCloud(seed, {40, 20, 20}, 0.6 + 0.03 * double(seed))}) {
    for (const auto& spacing : {std::array{1.0, 1.0, 1.0}, std::array{0.3, 0.7, 1.5}}) {
      const Volume object = Placed(points, spacing);
      const auto euclidean = ComputeDistance(object, DistanceKind::kEuclidean, {});
      ExpectDepths(object, ExactRadius(object));
      ExpectDepths(object, ExactRadius(object, *euclidean));
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Seeds, FirmDepthLaw, testing::Range<uint64_t>(0, 10, test::kStride));

// Single pits in the middle of stored bricks are taken one by one.
TEST(FirmDepth, PassesOverPitsInsideOfTheBody) {
  std::vector<LatticePoint> points = test::RandomCloud(1, {48, 16, 24}, 1);
  for (LatticePoint pit :
       {LatticePoint{40, 12, 20}, LatticePoint{41, 13, 21}, LatticePoint{50, 14, 22}}) {
    std::erase(points, pit);
  }
  const Volume object = VolumeOfPoints(points);
  ASSERT_EQ(WithoutPits(object).PointCount(), object.PointCount() + 3);
  ExpectDepths(object, ExactRadius(object));
}

// All background in the window is taken, and no more is found beyond.
TEST(FirmDepth, IsMoreThanTheExtentIsLongWhereTheWindowShowsPitsOnly) {
  std::vector<LatticePoint> points = test::RandomCloud(1, {64, 12, 16}, 1);
  for (LatticePoint pit : {LatticePoint{0, 0, 0}, {60, 12, 20}, {61, 3, 21}, {127, 23, 31}}) {
    std::erase(points, pit);
  }
  Volume object = VolumeOfPoints(points);
  object.SetWindow(LatticeBox{{0, 0, 0}, {127, 23, 31}});
  const ExactRadius radius(object);
  FirmDepth depth(object, radius);
  for (LatticePoint p : {LatticePoint{2, 2, 2}, {1, 1, 1}, {62, 12, 20}, {125, 21, 29}}) {
    ASSERT_GE(depth.AtMost(p), 128);
    ASSERT_GE(depth.At(p), 128);
  }
}

}  // namespace
}  // namespace bccskel
