#include "core/import/mesh/text_scanner.h"

#include <gtest/gtest.h>

namespace bccskel {
namespace {

TEST(TextScanner, CountsLinesWithAnyLineEndAndSkipsBlankAndCommentedOnes) {
  TextScanner text("a b\r\n\r\n# c\rd#e\nf", TextScanner::Comments::kHash, LineContinuation::kNone);
  ASSERT_TRUE(text.NextLine());
  EXPECT_EQ(text.Token(), "a");
  EXPECT_EQ(text.Token(), "b");
  EXPECT_EQ(text.Token(), "");
  ASSERT_TRUE(text.NextLine());
  EXPECT_EQ(text.line_number(), 4u);
  EXPECT_EQ(text.TokenAcrossLines(), "d");
  EXPECT_EQ(text.TokenAcrossLines(), "f");
  EXPECT_EQ(text.line_number(), 5u);
  EXPECT_FALSE(text.NextLine());
}

TEST(TextScanner, JoinsContinuedLinesAndKeepsCounting) {
  TextScanner text("a \\\n b\\\r\nc\nd", TextScanner::Comments::kNone,
                   LineContinuation::kBackslash);
  ASSERT_TRUE(text.NextLine());
  EXPECT_EQ(text.Token(), "a");
  EXPECT_EQ(text.Token(), "b");
  EXPECT_EQ(text.Token(), "c");
  EXPECT_EQ(text.Token(), "");
  ASSERT_TRUE(text.NextLine());
  EXPECT_EQ(text.line_number(), 4u);
}

TEST(ParseDouble, RoundsCorrectlyAndTakesWholeTokensOnly) {
  EXPECT_EQ(ParseDouble("-2.056562"), -2.056562);
  EXPECT_EQ(ParseDouble("+1e3"), 1000.0);
  EXPECT_EQ(ParseDouble("9007199254740993"), 9007199254740992.0);
  for (const char* bad : {"", "+", "+-1", "1x", "0x10", "1e999", "1,5", "--1"}) {
    EXPECT_EQ(ParseDouble(bad), std::nullopt) << bad;
  }
}

TEST(ParseInteger, RefusesWhatDoesNotFit) {
  EXPECT_EQ(ParseInteger("-7"), -7);
  EXPECT_EQ(ParseInteger("9223372036854775808"), std::nullopt);
  EXPECT_EQ(ParseInteger("1.0"), std::nullopt);
}

}  // namespace
}  // namespace bccskel
