#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <span>
#include <string>

#include "core/exec/status_macros.h"
#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/handmade_exr.h"
#include "tests/core/io/test_volumes.h"
#include "tests/support/volume_headers.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

absl::StatusOr<std::string> EncodePlanes(const Volume& volume) {
  return EncodeVolume(volume, {VolumeEncoding::kRawPlanes, VolumeCompression::kNone});
}

absl::StatusOr<Volume> DecodePlanes(const LatticeExtent& extent, std::span<const std::byte> bytes) {
  const auto decoder = MakeVolumeDecoder(*test::MakePlanesHeader(extent, {}, {}), {});
  BCCSKEL_RETURN_IF_ERROR((*decoder)->Append(bytes));
  return (*decoder)->Finish();
}

// 2 x 2 cells, 33 layers: two channels. Word order is [part][channel][y][x].
TEST(PlanesEncoding, HasTheDocumentedLayout) {
  VolumeBuilder builder({2, 2, 33});
  builder.Add(PointAt(Sublattice::kEven, 0, 0, 0));   // part 0, channel 0, y 0, x 0, bit 0
  builder.Add(PointAt(Sublattice::kEven, 1, 0, 31));  // part 0, channel 0, y 0, x 1, bit 31
  builder.Add(PointAt(Sublattice::kEven, 0, 1, 32));  // part 0, channel 1, y 1, x 0, bit 0
  builder.Add(PointAt(Sublattice::kOdd, 1, 1, 8));    // part 1, channel 0, y 1, x 1, bit 8
  const Volume volume = *std::move(builder).Build();
  const std::string expected = Bytes<uint32_t>(1, 0x80000000u, 0, 0, /**/ 0, 0, 1, 0,  //
                                               0, 0, 0, 0x100, /**/ 0, 0, 0, 0);
  const auto planes = EncodePlanes(volume);
  ASSERT_TRUE(planes.ok()) << planes.status();
  EXPECT_EQ(*planes, expected);
  EXPECT_EQ(*DecodePlanes({2, 2, 33}, BytesOf(expected)), volume);
}

TEST(PlanesEncoding, RefusesTooFewAndTooManyBytes) {
  const std::string planes = *EncodePlanes(CornerVolume({17, 5, 33}));
  for (size_t length : {size_t{0}, size_t{1}, planes.size() - 1}) {
    const auto volume = DecodePlanes({17, 5, 33}, BytesOf(planes).first(length));
    EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(volume.status().message()),
                HasSubstr("only " + std::to_string(length) + " were sent"));
  }
  const auto volume = DecodePlanes({17, 5, 33}, BytesOf(planes + "x"));
  EXPECT_THAT(std::string(volume.status().message()), HasSubstr("more were sent"));
}

TEST(PlanesEncoding, RefusesBitsPastTheLastLayer) {
  const std::string planes = Bytes<uint32_t>(0, 2, 0, 0);  // even, channel 1, bit 1: layer 33
  const auto volume = DecodePlanes({1, 1, 33}, BytesOf(planes));
  EXPECT_EQ(volume.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(volume.status().message()), HasSubstr("past the last of 33 layers"));
}

TEST(PlanesHeader, ChecksGridAndLimits) {
  const auto code = [](LatticeExtent extent, const VolumeLimits& limits) {
    return test::MakePlanesHeader(extent, {}, limits).status().code();
  };
  EXPECT_EQ(code({10, 10, 10}, {}), absl::StatusCode::kOk);
  EXPECT_EQ(code({10, 0, 10}, {}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code({10, 10, 10}, {.max_decoded_bytes = 800}), absl::StatusCode::kOk);
  EXPECT_EQ(code({10, 10, 10}, {.max_decoded_bytes = 799}), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(code({10, 10, 10}, {.max_extent_cells = 9}), absl::StatusCode::kResourceExhausted);
}

// 2^22 cells along each axis are 2^64 bytes of planes: one more than a counter holds.
TEST(PlanesHeader, DoesNotOverflowOnTheLargestExtent) {
  const LatticeExtent extent = {kMaxExtentCells, kMaxExtentCells, kMaxExtentCells};
  EXPECT_EQ(DensePlaneBytes(extent), ~uint64_t{0});
  EXPECT_EQ(test::MakePlanesHeader(extent, {}, {.max_decoded_bytes = ~uint64_t{0}}).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(PlanesHeader, EnforcesTheDeclaredBricks) {
  const std::string planes = *EncodePlanes(CornerVolume({17, 5, 33}));
  const auto header =
      test::MakePlanesHeader({17, 5, 33}, SkewedPlacement(), {}, VolumeCompression::kNone, 1);
  ASSERT_TRUE(header.ok()) << header.status();
  const auto decoder = MakeVolumeDecoder(*header, {});
  ASSERT_TRUE(decoder.ok()) << decoder.status();
  const absl::Status status = (*decoder)->Append(BytesOf(planes));
  EXPECT_EQ(status.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(status.message()), HasSubstr("more bricks than the 1 declared"));
}

TEST(PlanesHeader, RefusesCompressionsThatPlanesDoNotHave) {
  EXPECT_EQ(test::MakePlanesHeader({1, 1, 1}, {}, {}, VolumeCompression::kRle).status().code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel
