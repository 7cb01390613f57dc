#include "core/pruning/surface_noise.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>

#include "core/import/shapes/shapes.h"
#include "tests/core/pruning/simple_noise.h"

namespace bccskel {
namespace {

constexpr std::array<LatticePoint, 6> kAxes = {
    {{2, 0, 0}, {-2, 0, 0}, {0, 2, 0}, {0, -2, 0}, {0, 0, 2}, {0, 0, -2}}};

// As Roughness() is defined, point by point. Pits in bricks that are not stored do not count.
double SlowRoughness(const Volume& object) {
  const auto beside = [&](LatticePoint p) {
    return std::ranges::count_if(kAxes, [&](LatticePoint way) { return object.Contains(p + way); });
  };
  uint64_t points = 0, pits = 0;
  for (const BrickKey& key : object.keys()) {
    for (int bit = 0; bit < kBrickPoints; ++bit) {
      const LatticePoint p = PointOf(key.coordinates(), bit);
      if (object.Contains(p)) {
        points += beside(p) < 6;
      } else {
        pits += beside(p) >= 4;
      }
    }
  }
  return points == 0 ? 0 : static_cast<double>(pits) / static_cast<double>(points);
}

TEST(Roughness, IsThatOfItsDefinition) {
  std::mt19937_64 random(3);
  for (const uint64_t sixteenths : {1u, 5u, 9u, 14u, 16u}) {
    VolumeBuilder builder({37, 11, 19});
    for (int32_t z = 0; z < 38; ++z) {
      for (int32_t y = 0; y < 22; ++y) {
        for (int32_t x = 0; x < 74; ++x) {
          if (IsOnLattice({x, y, z}) && random() % 16 < sixteenths) builder.Add({x, y, z});
        }
      }
    }
    const Volume dust = *std::move(builder).Build();
    EXPECT_EQ(Roughness(dust), SlowRoughness(dust)) << sixteenths;
  }
  EXPECT_EQ(Roughness(Volume()), 0);
}

TEST(SurfaceNoise, IsOneStepButMoreThanAUnitWhereSmooth) {
  for (const Shape shape : {Shape::kHorse, Shape::kTorus, Shape::kBox}) {
    for (const uint64_t points : {20'000u, 200'000u}) {
      SCOPED_TRACE(testing::Message() << ShapeName(shape) << ' ' << points);
      const Volume smooth = *GenerateShape(shape, {.points = points});
      for (const double radius : {0.5, 3.0, 20.0}) {
        EXPECT_EQ(SurfaceNoiseOf(smooth, 1).At(radius), 1.5);
        EXPECT_EQ(SurfaceNoiseOf(smooth, 2.5).At(radius), 2.5);
      }
    }
  }
}

TEST(SurfaceNoise, IsThreeStepsWhereRoughButOneForThickBranchesOfVoxels) {
  const Volume smooth = *GenerateShape(Shape::kHorse, {.points = 50'000});
  const Volume rough = test::WithSimpleNoise(smooth, 0.05, 7);
  const SurfaceNoise points = SurfaceNoiseOf(rough, 1), voxels = SurfaceNoiseOf(rough, 2);
  EXPECT_EQ(points.roughness, 1);
  EXPECT_EQ(points.At(1.5), 3);
  EXPECT_EQ(points.At(3), 3);
  EXPECT_EQ(voxels.At(3), 6);
  EXPECT_EQ(voxels.At(4.5), 4);
  EXPECT_EQ(voxels.At(6), 2);
}

TEST(SurfaceNoise, IsAsLongAsTheVoxelsAre) {
  const Volume even = VolumeOfPoints({});
  EXPECT_EQ(SurfaceNoiseOf(even, 2).Stretch({3, 4, 5}), 1);
  const Volume flat = Volume::FromSortedBricks({1, 1, 1}, {.spacing = {1, 2, 1.5}}, {}, {});
  const SurfaceNoise noise = SurfaceNoiseOf(flat, 2, {1, 1, 4});  // voxels of 1 x 2 x 6
  EXPECT_EQ(noise.Stretch({7, 0, 0}), 1);
  EXPECT_EQ(noise.Stretch({0, 1, 0}), 2);
  EXPECT_EQ(noise.Stretch({0, 0, 2}), 6);
  EXPECT_DOUBLE_EQ(noise.Stretch({1, 0, 1}), std::sqrt((1 + 36) / 2.0));
}

}  // namespace
}  // namespace bccskel
