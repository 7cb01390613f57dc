#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/digest/sha256.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_digest.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/handmade_exr.h"
#include "tests/core/io/test_volumes.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

struct HandmadeBricks {
  std::string magic{"BCCB\r\n\x1a\n"};
  uint32_t version = 1, compression = 0, reserved = 0;
  LatticeExtent extent = {40, 9, 20};
  uint64_t count = 0;
  std::string placement = Bytes<double>(1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1);
  std::string records;

  void AddRecord(int32_t bx, int32_t by, int32_t bz, uint32_t sublattice, std::string words) {
    records += Bytes<int32_t>(bx, by, bz) + Bytes(sublattice) + words;
    ++count;
  }
  std::string Build() const {
    return magic + Bytes<uint32_t>(version, compression) +
           Bytes<int32_t>(extent.nx, extent.ny, extent.nz) + Bytes(reserved) + Bytes(count) +
           placement + records;
  }
};

std::string WordsWith(uint64_t first, uint64_t last = 0) {
  return Bytes<uint64_t>(first, 0, 0, 0, 0, 0, 0, last);
}

absl::StatusOr<Volume> Read(const HandmadeBricks& file, const VolumeLimits& limits = {}) {
  return DecodeVolume(VolumeEncoding::kBricks, file.Build(), limits);
}

TEST(BricksEncoding, PutsEveryBitOfAHandmadeRecordOnItsPoint) {
  HandmadeBricks file;
  file.AddRecord(0, 0, 0, 0, WordsWith(1));                               // even cell (0, 0, 0)
  file.AddRecord(2, 1, 1, 1, WordsWith(uint64_t{1} << (16 * 3 + 7)));     // odd cell (39, 7, 8)
  file.AddRecord(1, 0, 0, 1, WordsWith(0, uint64_t{1} << (16 * 2 + 5)));  // odd cell (21, 2, 7)
  const auto volume = Read(file);
  ASSERT_TRUE(volume.ok()) << volume.status();
  const std::vector<LatticePoint> expected = {{0, 0, 0}, {43, 5, 15}, {79, 15, 17}};
  EXPECT_EQ(volume->SortedPoints(), expected);
}

TEST(BricksEncoding, WritesWhatWouldBeMadeByHand) {
  VolumeBuilder builder({40, 9, 20});
  builder.Add({43, 5, 15});
  builder.Add({0, 0, 0});
  HandmadeBricks file;
  file.AddRecord(0, 0, 0, 0, WordsWith(1));
  file.AddRecord(1, 0, 0, 1, WordsWith(0, uint64_t{1} << (16 * 2 + 5)));
  const Volume volume = *std::move(builder).Build();
  const auto written = EncodeVolume(volume, {VolumeEncoding::kBricks, VolumeCompression::kNone});
  ASSERT_TRUE(written.ok()) << written.status();
  EXPECT_EQ(*written, file.Build());
  EXPECT_EQ(VolumeDigest(volume), Sha256Of(file.Build()).Hex());
}

TEST(BricksEncoding, TakesRecordsInAnyOrderAndDropsEmptyOnes) {
  HandmadeBricks sorted, shuffled;
  sorted.AddRecord(0, 0, 0, 0, WordsWith(1));
  sorted.AddRecord(1, 0, 0, 1, WordsWith(2));
  shuffled.AddRecord(1, 0, 0, 1, WordsWith(2));
  shuffled.AddRecord(2, 0, 0, 1, WordsWith(0));
  shuffled.AddRecord(0, 0, 0, 0, WordsWith(1));
  ASSERT_TRUE(Read(shuffled).ok()) << Read(shuffled).status();
  EXPECT_EQ(*Read(shuffled), *Read(sorted));
}

TEST(BricksEncoding, RefusesBadHeaders) {
  const auto message = [](auto bend) {
    HandmadeBricks file;
    file.AddRecord(0, 0, 0, 0, WordsWith(1));
    bend(file);
    const auto volume = Read(file);
    EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(volume.status().message());
  };
  EXPECT_THAT(message([](auto& f) { f.magic = "BCCB\n\n\x1a\n"; }), HasSubstr("magic"));
  EXPECT_THAT(message([](auto& f) { f.version = 2; }), HasSubstr("version 2"));
  EXPECT_THAT(message([](auto& f) { f.compression = 7; }), HasSubstr("compression 7"));
  EXPECT_THAT(message([](auto& f) { f.reserved = 1; }), HasSubstr("reserved field is 1"));
  EXPECT_THAT(message([](auto& f) { f.extent.ny = 0; }), HasSubstr("40 x 0 x 20"));
  EXPECT_THAT(message([](auto& f) { f.placement[7] = '\x7f'; }), HasSubstr("spacing"));
  EXPECT_THAT(message([](auto& f) { f.count = 0; }), HasSubstr("more bricks than the 0"));
  EXPECT_THAT(message([](auto& f) { f.count = 2; }), HasSubstr("end after 1 records"));
  EXPECT_THAT(message([](auto& f) { f.count = ~uint64_t{0}; }), HasSubstr("only 54 fit"));
  EXPECT_THAT(message([](auto& f) { f.records.pop_back(); }), HasSubstr("0 records and 79 bytes"));
  EXPECT_THAT(message([](auto& f) { f.compression = 1; }), HasSubstr("zstd frame"));
}

TEST(BricksEncoding, RefusesBadRecords) {
  const auto message = [](int32_t bx, int32_t by, int32_t bz, uint32_t sublattice, uint64_t bits) {
    HandmadeBricks file;
    file.AddRecord(0, 0, 0, 0, WordsWith(1));
    file.AddRecord(bx, by, bz, sublattice, WordsWith(bits));
    const auto volume = Read(file);
    EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
    return std::string(volume.status().message());
  };
  EXPECT_THAT(message(0, 0, 0, 0, 1), HasSubstr("given twice"));
  EXPECT_THAT(message(0, 0, 0, 2, 1), HasSubstr("sublattice 2"));
  EXPECT_THAT(message(-1, 0, 0, 0, 1), HasSubstr("(-1, 0, 0)"));
  EXPECT_THAT(message(3, 0, 0, 0, 1), HasSubstr("outside the extent"));
  EXPECT_THAT(message(0, 3, 0, 0, 1), HasSubstr("outside the extent"));
  EXPECT_THAT(message(0, 0, 3, 0, 1), HasSubstr("outside the extent"));
  EXPECT_THAT(message(1 << 21, 0, 0, 1, 1), HasSubstr("each coordinate must be"));
  EXPECT_THAT(message(0, 0, 2147483647, 1, 1), HasSubstr("each coordinate must be"));
  EXPECT_THAT(message(2, 0, 0, 0, 1 << 8), HasSubstr("points outside the extent"));
}

TEST(BricksEncoding, ChecksTheDeclaredBricksAgainstTheLimit) {
  HandmadeBricks file;
  file.AddRecord(0, 0, 0, 0, WordsWith(1));
  file.AddRecord(1, 0, 0, 0, WordsWith(1));
  EXPECT_TRUE(Read(file, {.max_bricks = 2}).ok());
  EXPECT_EQ(Read(file, {.max_bricks = 1}).status().code(), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(Read(file, {.max_decoded_bytes = 159}).status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(Read(file, {.max_extent_cells = 39}).status().code(),
            absl::StatusCode::kResourceExhausted);
}

// 64 MiB of zeros in a few kilobytes.
TEST(BricksEncoding, StopsAZstdBombAtTheDeclaredSize) {
  // The frame of planes that are all zeros, behind a header that declares one brick.
  const auto frame = EncodeVolume(EmptyVolume({512, 512, 512}),
                                  {VolumeEncoding::kRawPlanes, VolumeCompression::kZstd});
  ASSERT_TRUE(frame.ok());
  HandmadeBricks file;
  file.compression = 1;
  file.records = *frame;
  file.count = 1;
  const auto volume = Read(file);
  EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(volume.status().message()), HasSubstr("more bricks than the 1 declared"));
}

TEST(BricksEncoding, RefusesBytesAfterTheZstdFrame) {
  auto bytes =
      EncodeVolume(CornerVolume({40, 9, 20}), {VolumeEncoding::kBricks, VolumeCompression::kZstd});
  ASSERT_TRUE(bytes.ok());
  *bytes += *bytes;
  EXPECT_THAT(std::string(DecodeVolume(VolumeEncoding::kBricks, *bytes).status().message()),
              HasSubstr("after the end of the zstd frame"));
}

TEST(VolumeDigest, TellsVolumesApart) {
  const Volume volume = RandomVolume({30, 9, 20}, 1, {});
  Placement moved;
  moved.origin[2] = 1;
  EXPECT_NE(VolumeDigest(volume), VolumeDigest(RandomVolume({30, 9, 20}, 2, {})));
  EXPECT_NE(VolumeDigest(volume), VolumeDigest(RandomVolume({30, 9, 20}, 1, moved)));
  EXPECT_NE(VolumeDigest(EmptyVolume({1, 2, 3})), VolumeDigest(EmptyVolume({1, 2, 4})));
}

TEST(VolumeDigest, TakesNegativeZeroForZero) {
  Placement negative;
  negative.origin = {-0.0, -0.0, -0.0};
  negative.direction[1] = -0.0;
  EXPECT_EQ(VolumeDigest(RandomVolume({30, 9, 20}, 1, negative)),
            VolumeDigest(RandomVolume({30, 9, 20}, 1, {})));
}

}  // namespace
}  // namespace bccskel
