#include "client/view/packed_numbers.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <vector>

#include "absl/strings/escaping.h"

namespace bccskel::view {
namespace {

// The way back, as the page goes it.
std::vector<uint32_t> Unpack(const std::string& text) {
  std::string packed, bytes(1 << 20, '\0');
  EXPECT_TRUE(absl::Base64Unescape(text, &packed));
  uLongf size = bytes.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(bytes.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  std::vector<uint32_t> numbers;
  int64_t value = 0;
  for (size_t at = 0; at < size;) {
    uint64_t zigzag = 0, byte = 128;
    for (int shift = 0; byte >= 128; shift += 7) {
      byte = static_cast<uint8_t>(bytes[at++]);
      zigzag |= (byte & 127) << shift;
    }
    value += (zigzag & 1) != 0 ? -static_cast<int64_t>(zigzag / 2) - 1
                               : static_cast<int64_t>(zigzag / 2);
    numbers.push_back(static_cast<uint32_t>(value));
  }
  return numbers;
}

TEST(PackedNumbersTest, ComeBackAsTheyWere) {
  const std::vector<uint32_t> numbers = {0, 1, 63, 64, 0, 0xffffffff, 0, 65535, 65535, 7};
  EXPECT_EQ(Unpack(*PackNumbers(numbers)), numbers);
  EXPECT_TRUE(Unpack(*PackNumbers({})).empty());
}

TEST(PackedNumbersTest, NumbersThatGrowSlowlyTakeLittleRoom) {
  std::vector<uint32_t> numbers;
  for (uint32_t n = 0; n < 100000; ++n) numbers.push_back(3 * n);
  EXPECT_LT(PackNumbers(numbers)->size(), 1000u);
}

TEST(PackedNumbersTest, LongTextsComeBackAndEndAfterAStop) {
  std::string text;
  for (uint32_t n = 0; text.size() < 5'000'000; ++n) text += std::to_string(n * 2654435761u);
  std::string back(text.size(), '\0');
  uLongf size = back.size();
  const std::string packed = *Deflate(text);
  ASSERT_EQ(uncompress(reinterpret_cast<Bytef*>(back.data()), &size,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  EXPECT_TRUE(back == text);
  std::stop_source stop;
  stop.request_stop();
  exec::Context context;
  context.stop = stop.get_token();
  EXPECT_TRUE(absl::IsCancelled(Deflate(text, context).status()));
}

}  // namespace
}  // namespace bccskel::view
