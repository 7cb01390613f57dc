#include "core/import/image/foreground.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace bccskel {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

template <typename T>
ImageSlice RowOf(const std::vector<T>& values) {
  return {.nx = static_cast<int32_t>(values.size()),
          .ny = 1,
          .z = 4,
          .values = std::span<const T>(values)};
}

// The voxels of a row that are foreground, as 0 and 1.
template <typename T>
std::vector<int> Foreground(const std::vector<T>& values, const ForegroundRule& rule) {
  std::vector<uint64_t> words(WordsPerRow(static_cast<int32_t>(values.size())), ~uint64_t{0});
  ForegroundSlice(RowOf(values), rule, words);
  std::vector<int> bits;
  for (size_t n = 0; n < 64 * words.size(); ++n) {
    const int bit = static_cast<int>(words[n / 64] >> (n % 64) & 1);
    if (n < values.size()) {
      bits.push_back(bit);
    } else {
      EXPECT_EQ(bit, 0) << "of no voxel: " << n;
    }
  }
  return bits;
}

TEST(ForegroundRule, IsNonZeroByDefaultAndNanIsNeverInside) {
  EXPECT_THAT(Foreground<double>({0, -0.0, 1, -1, kNan}, ForegroundRule::NonZero()),
              ElementsAre(0, 0, 1, 1, 0));
  EXPECT_THAT(Foreground<double>({0, 2, kNan}, ForegroundRule::NonZero().Inverted()),
              ElementsAre(1, 0, 0));
  EXPECT_THAT(Foreground<int8_t>({0, -1, 5}, ForegroundRule::NonZero()), ElementsAre(0, 1, 1));
}

TEST(CountNotNumbers, CountsNanAlone) {
  EXPECT_EQ(CountNotNumbers(RowOf<double>({0, kNan, HUGE_VAL, -1, kNan})), 2);
  EXPECT_EQ(CountNotNumbers(RowOf<uint8_t>({0, 255})), 0);
}

TEST(ForegroundRule, TakesRangesWithOpenEnds) {
  const std::vector<float> values = {-2, -1, 0, 1, 2, static_cast<float>(kNan)};
  EXPECT_THAT(Foreground(values, *ForegroundRule::Range(-1, 1)), ElementsAre(0, 1, 1, 1, 0, 0));
  EXPECT_THAT(Foreground(values, ForegroundRule::Range(-1, 1)->Inverted()),
              ElementsAre(1, 0, 0, 0, 1, 0));
  EXPECT_THAT(Foreground(values, *ForegroundRule::From(1)), ElementsAre(0, 0, 0, 1, 1, 0));
  EXPECT_THAT(Foreground(values, *ForegroundRule::Below(0)), ElementsAre(1, 1, 0, 0, 0, 0));
  EXPECT_THAT(
      Foreground<float>({-HUGE_VALF, HUGE_VALF}, *ForegroundRule::Range(-ForegroundRule::kOpen, 0)),
      ElementsAre(1, 0));
}

TEST(ForegroundRule, IsExactWhereATypeCannotHoldTheEndsOfARange) {
  const float third = 1.0F / 3;  // above 1/3 in double
  EXPECT_THAT(Foreground<float>({third}, *ForegroundRule::Range(0, 1.0 / 3)), ElementsAre(0));
  EXPECT_THAT(Foreground<float>({third}, *ForegroundRule::From(1.0 / 3)), ElementsAre(1));
  const float seven_tenths = 0.7F;  // below 0.7 in double
  EXPECT_THAT(Foreground<float>({seven_tenths}, *ForegroundRule::From(0.7)), ElementsAre(0));
  EXPECT_THAT(Foreground<float>({seven_tenths}, *ForegroundRule::Below(0.7)), ElementsAre(1));
  EXPECT_THAT(Foreground<uint8_t>({0, 39, 40, 255}, *ForegroundRule::From(39.5)),
              ElementsAre(0, 0, 1, 1));
  EXPECT_THAT(Foreground<uint8_t>({0, 255}, *ForegroundRule::Range(256, 1e9)), ElementsAre(0, 0));
  EXPECT_THAT(Foreground<uint8_t>({0, 255}, ForegroundRule::Range(256, 1e9)->Inverted()),
              ElementsAre(1, 1));
  EXPECT_THAT(Foreground<uint64_t>({0, ~uint64_t{0}}, *ForegroundRule::From(0x1p63)),
              ElementsAre(0, 1));
  EXPECT_THAT(Foreground<int64_t>({INT64_MIN, INT64_MAX}, *ForegroundRule::From(-1)),
              ElementsAre(0, 1));
  EXPECT_THAT(Foreground<int8_t>({-128, 0, 127}, *ForegroundRule::Range(-1e300, 1e300)),
              ElementsAre(1, 1, 1));
}

TEST(ForegroundRule, TakesListsOfLabelsThatOnlySomeTypesHold) {
  const uint64_t large = (uint64_t{1} << 53) + 1;
  const auto rule = ForegroundRule::Labels({300, 7, 7, large});
  ASSERT_TRUE(rule.ok());
  EXPECT_THAT(Foreground<uint8_t>({7, 44, 0}, *rule), ElementsAre(1, 0, 0));
  EXPECT_THAT(Foreground<uint16_t>({7, 300, 0}, *rule), ElementsAre(1, 1, 0));
  EXPECT_THAT(Foreground<uint64_t>({large, large - 1, large + 1}, *rule), ElementsAre(1, 0, 0));
  EXPECT_THAT(Foreground<double>({7, 7.5, kNan, 0x1p53}, *rule), ElementsAre(1, 0, 0, 0));
  EXPECT_THAT(Foreground<double>({7, 7.5, kNan}, rule->Inverted()), ElementsAre(0, 1, 0));
  EXPECT_THAT(Foreground<int16_t>({-7, 7}, *ForegroundRule::Labels({7})), ElementsAre(0, 1));
  EXPECT_THAT(Foreground<int16_t>({-7, 7}, ForegroundRule::Labels({7})->Inverted()),
              ElementsAre(1, 0));
}

TEST(ForegroundRule, RefusesWhatHoldsNothing) {
  EXPECT_FALSE(ForegroundRule::Range(2, 1).ok());
  EXPECT_FALSE(ForegroundRule::Range(kNan, 1).ok());
  EXPECT_FALSE(ForegroundRule::Below(kNan).ok());
  EXPECT_FALSE(ForegroundRule::Labels({}).ok());
}

TEST(ForegroundSlice, AgreesWithEachVoxelForRowsOfAnyLength) {
  std::mt19937 random(7);
  for (const int32_t nx : {1, 7, 63, 64, 65, 130, 200}) {
    const int32_t ny = 3;
    std::vector<uint16_t> values(static_cast<size_t>(nx * ny));
    for (uint16_t& value : values) value = static_cast<uint16_t>(random() % 4);
    const ImageSlice slice = {
        .nx = nx, .ny = ny, .z = 0, .values = std::span<const uint16_t>(values)};
    std::vector<uint64_t> words(WordsPerRow(nx) * ny, ~uint64_t{0});
    ForegroundSlice(slice, *ForegroundRule::Range(2, 3), words);
    for (int32_t y = 0; y < ny; ++y) {
      for (size_t x = 0; x < 64 * WordsPerRow(nx); ++x) {
        const uint64_t word = words[static_cast<size_t>(y) * WordsPerRow(nx) + x / 64];
        const bool inside =
            x < static_cast<size_t>(nx) && values[static_cast<size_t>(y * nx) + x] >= 2;
        ASSERT_EQ((word >> (x % 64) & 1) != 0, inside) << nx << " " << x << " " << y;
      }
    }
  }
}

TEST(LabelSlice, GivesWholeNumbersAndNamesOthers) {
  std::vector<uint64_t> labels(3);
  ASSERT_TRUE(LabelSlice(RowOf<float>({0, 17, static_cast<float>(kNan)}), labels).ok());
  EXPECT_THAT(labels, ElementsAre(0, 17, 0));
  ASSERT_TRUE(LabelSlice(RowOf<uint64_t>({~uint64_t{0}, 0, 1}), labels).ok());
  EXPECT_THAT(labels, ElementsAre(~uint64_t{0}, 0, 1));
  for (const auto& status :
       {LabelSlice(RowOf<float>({0, 1.5F}), labels), LabelSlice(RowOf<int32_t>({0, -4}), labels),
        LabelSlice(RowOf<double>({0, 1e30}), labels)}) {
    EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(status.message()), HasSubstr("voxel (1, 0, 4)"));
  }
}

}  // namespace
}  // namespace bccskel
