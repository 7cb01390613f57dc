#include <gtest/gtest.h>

#include <chrono>
#include <limits>

#include "server/settings/setting.h"

namespace bccskel::server {
namespace {

TEST(ParseSize, TakesUnitsOf1024InSeveralSpellings) {
  for (const auto& [text, bytes] :
       {std::pair<const char*, uint64_t>{"0", 0},
        {"77", 77},
        {"1KB", 1024},
        {"1k", 1024},
        {"3 MiB", uint64_t{3} << 20},
        {"2gb", uint64_t{2} << 30},
        {"1TB", uint64_t{1} << 40},
        {"18446744073709551615", std::numeric_limits<uint64_t>::max()}}) {
    const auto parsed = ParseSize(text, 0);
    ASSERT_TRUE(parsed.ok()) << text << parsed.status();
    EXPECT_EQ(*parsed, bytes) << text;
  }
}

TEST(ParseSize, RefusesWhatIsNoSizeOrTooLargeOrTooSmall) {
  for (const char* text : {"", "GB", "-1", "1.5GB", "2 furlongs", "1EB", "20000000TB", "1 2",
                           "18446744073709551616", "9"}) {
    EXPECT_FALSE(ParseSize(text, 10).ok()) << text;
  }
}

TEST(HoursSetting, TakesPartsOfAnHourAndShowsWhatItWillReadAgain) {
  std::chrono::seconds kept(0);
  const Setting setting = HoursSetting("keep", kept, "");
  for (const auto& [text, seconds] : {std::pair("168", 604800), {"0.02", 72}, {"0.0123", 44}}) {
    ASSERT_TRUE(setting.set({text}).ok()) << text;
    EXPECT_EQ(kept.count(), seconds);
    ASSERT_TRUE(setting.set({setting.show()}).ok()) << setting.show();
    EXPECT_EQ(kept.count(), seconds) << setting.show();
  }
  for (const char* text : {"", "0", "0.001", "-1", "9000", "nan", "inf", "1h", "0x10", "0X1P4"}) {
    EXPECT_FALSE(setting.set({text}).ok()) << text;
  }
}

}  // namespace
}  // namespace bccskel::server
