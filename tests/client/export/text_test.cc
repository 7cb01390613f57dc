#include "client/export/text.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace bccskel::exporting {
namespace {

template <typename Number>
std::string Shortest(Number number) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

template <typename Number>
std::string Written(Number number) {
  Text text;
  text.Add(number);
  return std::move(text).Take();
}

TEST(TextTest, WholeNumbersAndHalvesAreWrittenInTheShortestForm) {
  for (int halves = -50'000; halves <= 50'000; ++halves) {
    EXPECT_EQ(Written(halves / 2.0), Shortest(halves / 2.0));
  }
}

TEST(TextTest, NumbersWithFewBinaryPlacesAreWrittenInTheShortestForm) {
  for (int places = 1; places <= 14; ++places) {
    for (int parts = 1; parts < (20'000 << places); parts += 1 + parts / 40) {
      const double number = std::ldexp(parts, -places);
      EXPECT_EQ(Written(number), Shortest(number));
      EXPECT_EQ(Written(-number), Shortest(-number));
      const auto narrow = static_cast<float>(number);
      EXPECT_EQ(Written(narrow), Shortest(narrow));
    }
  }
}

TEST(TextTest, OtherNumbersAreWrittenInTheShortestForm) {
  constexpr double kTiny = std::numeric_limits<double>::denorm_min();
  for (double number : {0.0, -0.0, 0.1, -0.25, 1e4, 12345.5, 123456.0, 3e5, 1e15, 1e22, -1e300,
                        1e-7, kTiny, 2 - 1e-15, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(Written(number), Shortest(number));
  }
}

TEST(TextTest, PartsOfAnyLengthFollowEachOther) {
  Text text;
  std::string expected;
  for (size_t length = 0; length < 300; ++length) {
    text.Add(std::string(length, 'a'), std::string_view(), 'b', length);
    expected += std::string(length, 'a') + 'b' + std::to_string(length);
  }
  EXPECT_EQ(std::move(text).Take(), expected);
}

}  // namespace
}  // namespace bccskel::exporting
