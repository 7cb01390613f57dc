#include "core/digest/crc32c.h"

#include <gtest/gtest.h>

#include <string>

namespace bccskel {
namespace {

TEST(Crc32cTest, HasTheValuesOfRfc3720) {
  EXPECT_EQ(Crc32c("123456789"), 0xE3069283u);
  EXPECT_EQ(Crc32c(std::string(32, '\0')), 0x8A9136AAu);
  EXPECT_EQ(Crc32c(std::string(32, '\xFF')), 0x62A8AB43u);
  EXPECT_EQ(Crc32c(""), 0u);
}

TEST(Crc32cTest, TheInstructionAndTheTablesAgreeAtEveryLengthAndCut) {
  std::string text;
  for (int n = 0; n < 67; ++n) {
    for (size_t cut = 0; cut <= text.size(); ++cut) {
      const std::string front = text.substr(0, cut), back = text.substr(cut);
      const uint32_t whole = PlainCrc32c(std::as_bytes(std::span(text)));
      ASSERT_EQ(Crc32c(back, Crc32c(front)), whole) << n << " cut at " << cut;
      ASSERT_EQ(PlainCrc32c(std::as_bytes(std::span(back)), Crc32c(front)), whole);
    }
    text.push_back(static_cast<char>(n * 37 + 11));
  }
}

}  // namespace
}  // namespace bccskel
