// OpenEXR volumes as bytes: files made by hand against the reader, the writer against programs that
// others wrote.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/handmade_exr.h"
#include "tests/core/io/test_volumes.h"

namespace bccskel::exr_volume {
namespace {

using testing::HasSubstr;

constexpr LatticeExtent kExtent = {18, 5, 40};

absl::StatusOr<Volume> Read(const std::string& bytes) {
  return DecodeVolume(VolumeEncoding::kOpenExr, bytes);
}

TEST(ExrVolume, PutsEveryBitOfAHandmadeFileOnItsPoint) {
  HandmadeExr file(kExtent);
  file.SetPoint(0, 0, 0, 0);
  file.SetPoint(0, 17, 4, 39);
  file.SetPoint(1, 3, 2, 31);
  file.SetPoint(1, 3, 2, 32);
  const auto volume = Read(file.Build());
  ASSERT_TRUE(volume.ok()) << volume.status();
  const std::vector<LatticePoint> expected = {{0, 0, 0}, {7, 5, 63}, {7, 5, 65}, {34, 8, 78}};
  EXPECT_EQ(volume->SortedPoints(), expected);
}

TEST(ExrVolume, WritesWhatWouldBeMadeByHand) {
  const Volume volume = RandomVolume(kExtent, 11, {});
  HandmadeExr file(kExtent);
  volume.ForEachPoint(
      [&](LatticePoint p) { file.SetPoint(p.x & 1, p.x >> 1, p.y >> 1, p.z >> 1); });
  const auto written = EncodeVolume(volume, {VolumeEncoding::kOpenExr, VolumeCompression::kNone});
  ASSERT_TRUE(written.ok()) << written.status();
  const std::string by_hand = file.Build();
  // Attributes may come in any order; the chunks, 12 bytes of leader each, may not.
  const size_t chunks = 2 * 5 * (12 + 18 * 2 * 4);
  EXPECT_EQ(written->substr(written->size() - chunks), by_hand.substr(by_hand.size() - chunks));
  EXPECT_EQ(*Read(by_hand), volume);
}

TEST(ExrVolume, RefusesBitsPastTheLastLayer) {
  HandmadeExr file(kExtent);
  file.SetPoint(1, 2, 3, 40);
  const auto volume = Read(file.Build());
  EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(volume.status().message()), HasSubstr("past the last of 40 layers"));
}

TEST(ExrVolume, RefusesMoreBricksThanDeclared) {
  HandmadeExr file(kExtent);
  file.SetPoint(0, 0, 0, 0);
  file.SetPoint(1, 0, 0, 0);
  file.Add({"bccBricks", "int", Bytes<int32_t>(1)});
  const auto volume = Read(file.Build());
  EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(volume.status().message()), HasSubstr("more bricks than the 1 declared"));
}

class HandmadeChunks : public testing::Test {
 protected:
  HandmadeChunks() : file_(kExtent), bytes_(file_.Build()), table_(file_.Header().size()) {}

  void Put(size_t offset, const std::string& value) { bytes_.replace(offset, value.size(), value); }
  size_t FirstChunk() const { return table_ + 2 * 5 * 8; }
  std::string Message() const {
    const auto volume = Read(bytes_);
    EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(volume.status().message());
  }

  HandmadeExr file_;
  std::string bytes_;
  size_t table_;
};

TEST_F(HandmadeChunks, MustBelongToTheirPart) {
  Put(FirstChunk(), Bytes<int32_t>(1));
  EXPECT_THAT(Message(), HasSubstr("chunk 0 of part even: part is 1, must be 0"));
}

TEST_F(HandmadeChunks, MustBelongToTheirLine) {
  Put(FirstChunk() + 4, Bytes<int32_t>(3));
  EXPECT_THAT(Message(), HasSubstr("first line is 3, must be 0"));
}

TEST_F(HandmadeChunks, MustHaveTheSizeOfTheirLines) {
  for (int32_t size : {0, -1, 143, 145, 2147483647}) {
    Put(FirstChunk() + 8, Bytes(size));
    EXPECT_THAT(Message(), HasSubstr("size is " + std::to_string(size)));
  }
}

TEST_F(HandmadeChunks, MustLieInsideTheFile) {
  for (uint64_t offset : {uint64_t{0}, uint64_t{FirstChunk() - 1}, uint64_t{bytes_.size() - 11},
                          uint64_t{bytes_.size() + 1}, ~uint64_t{0}}) {
    Put(table_, Bytes(offset));
    EXPECT_THAT(Message(), HasSubstr("lies outside the file"));
  }
}

TEST_F(HandmadeChunks, MustFillTheFile) {
  bytes_ += "x";
  EXPECT_THAT(Message(), HasSubstr("header, tables and chunks take"));
}

// OpenEXR takes an empty compressed chunk for whatever its buffer held before.
TEST_F(HandmadeChunks, MustNotBeEmptyWhenCompressed) {
  file_.Set("compression", "\1");
  bytes_ = file_.Build();
  Put(FirstChunk() + 8, Bytes<int32_t>(0));
  EXPECT_THAT(Message(), HasSubstr("size is 0, must be 1 to 144"));
}

}  // namespace
}  // namespace bccskel::exr_volume
