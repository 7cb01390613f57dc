#include "core/io/volume_encoder.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/io/volume_decoder.h"
#include "tests/core/io/test_volumes.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

// Two points at the ends of a box of 2^63 points.
Volume HugeBox() { return CornerVolume({1 << 21, 1 << 21, 1 << 20}); }

TEST(VolumeEncoder, RefusesAHugeBoxDenselyAndNamesTheWayOut) {
  for (VolumeEncoding encoding : {VolumeEncoding::kOpenExr, VolumeEncoding::kRawPlanes}) {
    const auto bytes = EncodeVolume(HugeBox(), {encoding, VolumeCompression::kNone});
    EXPECT_EQ(bytes.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(bytes.status().message()), HasSubstr("bricks (.bccb)"));
  }
}

TEST(VolumeEncoder, SavesAHugeBoxAsBricks) {
  const auto bytes = EncodeVolume(HugeBox(), {VolumeEncoding::kBricks, VolumeCompression::kNone});
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  EXPECT_EQ(bytes->size(), 160u + 2 * 80);
  EXPECT_EQ(*DecodeVolume(VolumeEncoding::kBricks, *bytes), HugeBox());
}

TEST(VolumeEncoder, RefusesMoreLayersThanAnOpenExrHeaderHolds) {
  const Volume tall = CornerVolume({1, 1, 32 * 1400 + 1});
  const auto bytes = EncodeVolume(tall);
  EXPECT_EQ(bytes.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(bytes.status().message()), HasSubstr("use the bricks encoding"));
}

TEST(VolumeEncoder, WritesTheMostLayersThatAnOpenExrHeaderHolds) {
  const Volume tall = CornerVolume({2, 2, 32 * 1400});
  const auto bytes = EncodeVolume(tall);
  ASSERT_TRUE(bytes.ok()) << bytes.status();
  const auto back = DecodeVolume(VolumeEncoding::kOpenExr, *bytes);
  ASSERT_TRUE(back.ok()) << back.status();
  EXPECT_EQ(*back, tall);
}

TEST(VolumeEncoder, RefusesAVolumeWithoutExtent) {
  EXPECT_EQ(EncodeVolume(Volume()).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(VolumeEncoder, RefusesCompressionsThatTheEncodingDoesNotHave) {
  const Volume volume = FullVolume({2, 2, 2});
  for (auto [encoding, compression] :
       {std::pair{VolumeEncoding::kOpenExr, VolumeCompression::kZstd},
        std::pair{VolumeEncoding::kBricks, VolumeCompression::kZip},
        std::pair{VolumeEncoding::kRawPlanes, VolumeCompression::kRle}}) {
    EXPECT_EQ(EncodeVolume(volume, {encoding, compression}).status().code(),
              absl::StatusCode::kInvalidArgument);
  }
}

class FullSink final : public ByteSink {
 public:
  absl::Status WriteAt(uint64_t offset, std::span<const std::byte> bytes) override {
    if (offset + bytes.size() <= 500) return absl::OkStatus();
    return absl::ResourceExhaustedError("no space left");
  }
};

TEST(VolumeEncoder, PassesOnWhatTheSinkSays) {
  const Volume volume = FullVolume({40, 40, 40});
  for (auto encoding :
       {VolumeEncoding::kOpenExr, VolumeEncoding::kRawPlanes, VolumeEncoding::kBricks}) {
    FullSink sink;
    const auto status = EncodeVolumeTo(volume, {encoding, VolumeCompression::kNone}, sink);
    EXPECT_EQ(status, absl::ResourceExhaustedError("no space left"));
  }
}

}  // namespace
}  // namespace bccskel
