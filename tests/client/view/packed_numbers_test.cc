#include "client/view/packed_numbers.h"

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

std::string Inflate(const std::string& packed, size_t size) {
  std::string back(size + 1, '\0');
  uLongf written = back.size();
  EXPECT_EQ(uncompress(reinterpret_cast<Bytef*>(back.data()), &written,
                       reinterpret_cast<const Bytef*>(packed.data()), packed.size()),
            Z_OK);
  back.resize(written);
  return back;
}

std::string LongText() {
  std::string text;
  for (uint32_t n = 0; text.size() < 5'000'000; ++n) text += std::to_string(n * 2654435761u);
  return text;
}

TEST(PackedNumbersTest, TextsOfAnyLengthComeBack) {
  const std::string text = LongText();
  constexpr size_t kPiece = size_t{1} << 19;  // of Deflate()
  for (const size_t size : {size_t{0}, size_t{1}, kPiece - 1, kPiece, kPiece + 1, 3 * kPiece,
                            3 * kPiece + 40'000, text.size()}) {
    const std::string part = text.substr(0, size);
    EXPECT_TRUE(Inflate(*Deflate(part), size) == part) << size;
  }
}

TEST(PackedNumbersTest, ThreadsPackTheSameBytes) {
  const std::string text = LongText();
  exec::WorkerTeam team(3);
  exec::Context context;
  context.team = &team;
  EXPECT_TRUE(*Deflate(text, context) == *Deflate(text));
}

TEST(PackedNumbersTest, LongTextsEndAfterAStop) {
  const std::string text = LongText();
  std::stop_source stop;
  stop.request_stop();
  exec::Context context;
  context.stop = stop.get_token();
  EXPECT_TRUE(absl::IsCancelled(Deflate(text, context).status()));
}

}  // namespace
}  // namespace bccskel::view
