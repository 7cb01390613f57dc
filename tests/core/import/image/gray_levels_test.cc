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
