#include "core/import/image/gray_levels.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace bccskel {
namespace {

using ::testing::AllOf;
using ::testing::Ge;
using ::testing::Le;
using ::testing::Optional;

constexpr ImageSize kImage = {60, 50, 40};

// Of an image with value(x, y, z).
template <typename T>
GrayLevels LevelsOf(const std::function<T(int, int, int)>& value) {
  GrayLevels levels(kImage);
  for (int z = 0; z < kImage.nz; ++z) {
    std::vector<T> voxels;
    for (int y = 0; y < kImage.ny; ++y) {
      for (int x = 0; x < kImage.nx; ++x) voxels.push_back(value(x, y, z));
    }
    levels.Add({kImage.nx, kImage.ny, z, std::span<const T>(voxels)});
  }
  return levels;
}

double FromMiddle(int x, int y, int z) { return std::hypot(x - 30, y - 25, z - 20); }

TEST(GrayLevels, AreNoMaskAndNoLabels) {
  const auto mask =
      LevelsOf<uint8_t>([](int x, int y, int z) { return FromMiddle(x, y, z) < 15 ? 255 : 0; });
  EXPECT_EQ(mask.Threshold(), std::nullopt);
  EXPECT_FALSE(mask.HasBothSigns());
  const auto labels = LevelsOf<uint32_t>([](int x, int y, int z) {
    return static_cast<uint32_t>(x / 4 + 100 * (y / 4) + 10'000 * (z / 4));
  });
  EXPECT_EQ(labels.Threshold(), std::nullopt);
  EXPECT_FALSE(labels.HasBothSigns());
}

// From 1 inside a ball to 0 outside, over `edge` voxels.
double Ball(int x, int y, int z, double edge) {
  return std::clamp((15 - FromMiddle(x, y, z)) / edge, 0.0, 1.0);
}

TEST(GrayLevels, OfSeveralLabelsAreToldFromMasks) {
  const auto labels = LevelsOf<uint16_t>([](int x, int y, int z) {
    return static_cast<uint16_t>(Ball(x, y, z, 1e-9) * (x < 32 ? 700 : 2));
  });
  EXPECT_TRUE(labels.HasSeveralLabels());
  const auto thin = LevelsOf<int64_t>([](int x, int y, int) { return x % 4 == 0 ? y % 3 : 0; });
  EXPECT_TRUE(thin.HasSeveralLabels());
  for (const int label : {1, 7, 255}) {
    const auto mask = LevelsOf<uint8_t>(
        [&](int x, int y, int z) { return static_cast<uint8_t>(Ball(x, y, z, 1e-9) * label); });
    EXPECT_FALSE(mask.HasSeveralLabels()) << label;
  }
  const auto soft = LevelsOf<uint8_t>(
      [](int x, int y, int z) { return static_cast<uint8_t>(255 * Ball(x, y, z, 1)); });
  EXPECT_FALSE(soft.HasSeveralLabels());
  const auto signs = LevelsOf<int8_t>([](int x, int, int) { return x < 9 ? 0 : x < 30 ? -1 : 1; });
  EXPECT_FALSE(signs.HasSeveralLabels());
  const auto floats = LevelsOf<float>([](int x, int, int) { return x < 30 ? 1.0F : 2.0F; });
  EXPECT_FALSE(floats.HasSeveralLabels());
}

TEST(GrayLevels, OfANoisyScanAreParted) {
  std::mt19937 random(5);
  std::normal_distribution<double> noise(0, 8);
  const auto scan = [&](int x, int y, int z) {
    return (FromMiddle(x, y, z) < 15 ? 180 : 60) + noise(random);
  };
  EXPECT_THAT(LevelsOf<uint8_t>([&](int x, int y, int z) {
                return static_cast<uint8_t>(scan(x, y, z));
              }).Threshold(),
              Optional(AllOf(Ge(90), Le(150))));
  const auto hounsfield = LevelsOf<int16_t>(
      [&](int x, int y, int z) { return static_cast<int16_t>(10 * scan(x, y, z) - 1000); });
  EXPECT_THAT(hounsfield.Threshold(), Optional(AllOf(Ge(-100), Le(500))));
  EXPECT_TRUE(hounsfield.HasBothSigns());
}

TEST(GrayLevels, NanAndInfinityAreNoValues) {
  const float kNan = std::numeric_limits<float>::quiet_NaN();
  const auto some =
      LevelsOf<float>([&](int x, int, int) { return x % 2 == 0 ? kNan : static_cast<float>(x); });
  EXPECT_THAT(some.Threshold(), Optional(AllOf(Ge(25), Le(35))));
  EXPECT_EQ(LevelsOf<double>([](int, int, int) { return HUGE_VAL; }).Threshold(), std::nullopt);
  EXPECT_FALSE(LevelsOf<float>([&](int, int, int) { return kNan; }).HasBothSigns());
}

TEST(GrayLevels, OfALevelSetHaveBothSigns) {
  const auto band = LevelsOf<float>([](int x, int y, int z) {
    return static_cast<float>(std::clamp(FromMiddle(x, y, z) - 15, -2.0, 2.0));
  });
  EXPECT_TRUE(band.HasBothSigns());
  EXPECT_EQ(band.Threshold(), std::nullopt);
}

}  // namespace
}  // namespace bccskel
