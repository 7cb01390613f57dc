#include "client/export/text.h"

#include <gtest/gtest.h>

#include <array>
#include <charconv>
#include <limits>
#include <string>
#include <utility>

namespace bccskel::exporting {
namespace {

std::string Shortest(double number) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), number).ptr};
}

std::string Written(double number) {
  Text text;
  text.Add(number);
  return std::move(text).Take();
}

TEST(TextTest, WholeNumbersAndHalvesAreWrittenInTheShortestForm) {
  for (int halves = -50'000; halves <= 50'000; ++halves) {
    EXPECT_EQ(Written(halves / 2.0), Shortest(halves / 2.0));
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
