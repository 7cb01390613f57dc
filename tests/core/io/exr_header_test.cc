#include "core/io/exr_header.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "tests/core/io/handmade_exr.h"
#include "tests/core/io/test_volumes.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

constexpr LatticeExtent kExtent = {5, 3, 40};

TEST(ExrHeader, AcceptsAFileMadeByHand) {
  HandmadeExr file(kExtent);
  file.Set("bccSpacing", Bytes<double>(0.5, 0.25, 2));
  file.Set("bccOrigin", Bytes<double>(-1, 2, 3));
  file.Set("bccDirection", Bytes<double>(0, 1, 0, -1, 0, 0, 0, 0, 1));
  const std::string bytes = file.Build();
  const auto header = ScanExrHeader(BytesOf(bytes), {});
  ASSERT_TRUE(header.ok()) << header.status();
  EXPECT_EQ(header->header_bytes, file.Header().size());
  EXPECT_EQ(header->volume.extent, kExtent);
  EXPECT_EQ(header->volume.placement.spacing, (std::array<double, 3>{0.5, 0.25, 2}));
  EXPECT_EQ(header->volume.placement.origin, (std::array<double, 3>{-1, 2, 3}));
  EXPECT_EQ(header->volume.placement.direction,
            (std::array<double, 9>{0, 1, 0, -1, 0, 0, 0, 0, 1}));
  EXPECT_EQ(header->volume.compression, VolumeCompression::kNone);
  EXPECT_FALSE(header->volume.declared_bricks.has_value());
  EXPECT_EQ(header->volume.decoded_bytes, 2u * 2 * 5 * 3 * 4);
}

TEST(ExrHeader, ReadsTheDeclaredNumberOfBricks) {
  HandmadeExr file(kExtent);
  file.Add({"bccBricks", "int", Bytes<int32_t>(3)});
  const auto header = ScanExrHeader(BytesOf(file.Build()), {});
  ASSERT_TRUE(header.ok()) << header.status();
  EXPECT_EQ(header->volume.declared_bricks, 3u);
  EXPECT_EQ(header->volume.max_bricks, 3u);
}

// A server knows the compression from the file alone, and takes the one that needs most memory.
TEST(ExrHeader, OfAnyCompressionBoundsTheFilesOfAll) {
  for (const LatticeExtent extent : {LatticeExtent{4, 33000, 2}, {3, 70, 40}}) {
    VolumeBuilder builder(extent);
    for (int32_t n = 0; n < 2 * extent.ny; n += 14) builder.Add({2, n, 2 * (n / 7 % extent.nz)});
    const Volume volume = *std::move(builder).Build();
    for (const VolumeCompression stated : {VolumeCompression::kRle, VolumeCompression::kZip}) {
      VolumeHeader declared;
      declared.encoding = VolumeEncoding::kOpenExr;
      declared.compression = stated;
      declared.extent = extent;
      const auto header = CompleteVolumeHeader(declared, {});
      ASSERT_TRUE(header.ok()) << header.status();
      for (const VolumeCompression used : {VolumeCompression::kNone, VolumeCompression::kRle,
                                           VolumeCompression::kZips, VolumeCompression::kZip}) {
        const auto bytes =
            EncodeVolume(volume, {.encoding = VolumeEncoding::kOpenExr, .compression = used});
        ASSERT_TRUE(bytes.ok()) << bytes.status();
        EXPECT_LE(bytes->size(), header->max_encoded_bytes) << VolumeCompressionName(used);
      }
    }
  }
}

struct BadHeader {
  std::string name;
  std::function<void(HandmadeExr&)> bend;
  std::string message;
  absl::StatusCode code = absl::StatusCode::kInvalidArgument;
};

std::vector<BadHeader> BadHeaders() {
  const auto set = [](std::string name, std::string value) {
    return [=](HandmadeExr& file) { file.Set(name, value); };
  };
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  return {
      {"Magic", [](auto& f) { f.magic = 1; }, "magic"},
      {"SinglePart", [](auto& f) { f.version = 2; }, "version and flags 0x2"},
      {"Tiled", [](auto& f) { f.version = 0x1202; }, "version and flags"},
      {"Deep", [](auto& f) { f.version = 0x1802; }, "version and flags"},
      {"LongNames", [](auto& f) { f.version = 0x1402; }, "version and flags"},
      {"OnePart", [](auto& f) { f.parts.pop_back(); }, "is missing"},
      {"ThreeParts", [](auto& f) { f.parts.push_back(f.parts[1]); }, "exactly two parts"},
      {"SwappedParts", [](auto& f) { std::swap(f.parts[0], f.parts[1]); }, "name must be 'even'"},
      {"TiledType", set("type", "tiledimage"), "type must be 'scanlineimage'"},
      {"DeepType", set("type", "deepscanline"), "type must be 'scanlineimage'"},
      {"MissingExtent", [](auto& f) { f.Rename("bccExtent", "bccBricks"); }, "bccBricks"},
      {"MissingType",
       [](auto& f) {
         for (auto& part : f.parts) std::erase_if(part, [](auto& a) { return a.name == "type"; });
       },
       "type is missing"},
      {"UnknownAttribute",
       [](auto& f) {
         f.Add({"owner", "string", "me"});
       },
       "'owner'"},
      {"AttributeTwice",
       [](auto& f) {
         f.Add({"name", "string", "even"});
       },
       "given twice"},
      {"WrongAttributeType", [](auto& f) { f.SetType("bccProfile", "float"); }, "type 'float'"},
      {"ShortAttribute", set("bccExtent", Bytes<int32_t>(5, 3)), "8 bytes: must have 12"},
      {"LongAttributeName", [](auto& f) { f.Rename("name", std::string(60, 'n')); }, "malformed"},
      {"Profile2", set("bccProfile", Bytes<int32_t>(2)), "profile version 2"},
      {"Piz", set("compression", "\4"), "compression 4"},
      {"DecreasingY", set("lineOrder", "\1"), "lineOrder 1"},
      {"RandomY", set("lineOrder", "\2"), "lineOrder 2"},
      {"WindowOffset", set("dataWindow", Bytes<int32_t>(1, 0, 5, 2)), "dataWindow"},
      {"WindowTooWide", set("dataWindow", Bytes<int32_t>(0, 0, 5, 2)), "number 2 is 5, must be 4"},
      {"DisplayWindow", set("displayWindow", Bytes<int32_t>(0, 0, 4, 3)), "displayWindow"},
      {"HalfPixels",
       [](auto& f) {
         for (auto& part : f.parts) f.Find(part, "channels").value[6] = 1;
       },
       "z0000 must be of type UINT"},
      {"Subsampled",
       [](auto& f) {
         for (auto& part : f.parts) f.Find(part, "channels").value[14] = 2;
       },
       "sampled at every pixel"},
      {"ChannelName",
       [](auto& f) {
         for (auto& part : f.parts) f.Find(part, "channels").value[0] = 'y';
       },
       "must have the name z0000"},
      {"TooFewChannels", set("channels", HandmadeExr::ChannelList(1)), "name z0001"},
      {"TooManyChannels", set("channels", HandmadeExr::ChannelList(3)), "exactly 2"},
      {"ChannelsCut",
       [](auto& f) {
         for (auto& part : f.parts) f.Find(part, "channels").value.pop_back();
       },
       "exactly 2"},
      {"ChunkCount", set("chunkCount", Bytes<int32_t>(4)), "chunkCount 4: must be 3"},
      {"HugeChunkCount", set("chunkCount", Bytes<int32_t>(2147483647)), "chunkCount"},
      {"ZeroExtent", set("bccExtent", Bytes<int32_t>(0, 3, 40)), "0 x 3 x 40"},
      {"NegativeExtent", set("bccExtent", Bytes<int32_t>(5, -3, 40)), "-3"},
      {"HugeExtent", set("bccExtent", Bytes<int32_t>(2147483647, 3, 40)), "2147483647"},
      {"ExtentOverTheLimit", set("bccExtent", Bytes<int32_t>(2000, 3, 40)), "1000 cells",
       absl::StatusCode::kResourceExhausted},
      {"OddExtentDiffers",
       [](auto& f) { f.Find(f.parts[1], "bccSpacing").value = Bytes<double>(2, 2, 2); }, "differ"},
      {"ZeroSpacing", set("bccSpacing", Bytes<double>(1, 0, 1)), "spacing 0"},
      {"NanSpacing", set("bccSpacing", Bytes<double>(1, 1, nan)), "spacing nan"},
      {"InfiniteOrigin", set("bccOrigin", Bytes<double>(infinity, 0, 0)), "finite"},
      {"NegativeBricks",
       [](auto& f) {
         f.Add({"bccBricks", "int", Bytes<int32_t>(-1)});
       },
       "-1"},
      {"MoreBricksThanFit",
       [](auto& f) {
         f.Add({"bccBricks", "int", Bytes<int32_t>(999)});
       },
       "only 10 fit"},
  };
}

TEST(ExrHeader, RefusesEverythingOutsideTheProfile) {
  const VolumeLimits limits = {.max_extent_cells = 1000};
  for (const BadHeader& bad : BadHeaders()) {
    HandmadeExr file(kExtent);
    bad.bend(file);
    const auto header = ScanExrHeader(BytesOf(file.Header()), limits);
    EXPECT_EQ(header.status().code(), bad.code) << bad.name << ": " << header.status();
    EXPECT_THAT(std::string(header.status().message()), HasSubstr(bad.message)) << bad.name;
  }
}

TEST(ExrHeader, RefusesEveryTruncation) {
  const std::string header = HandmadeExr(kExtent).Header();
  for (size_t length = 0; length < header.size(); ++length) {
    const auto scanned = ScanExrHeader(BytesOf(header).first(length), {});
    ASSERT_EQ(scanned.status().code(), absl::StatusCode::kInvalidArgument) << length << " bytes";
  }
  EXPECT_TRUE(ScanExrHeader(BytesOf(header), {}).ok());
}

TEST(ExrHeader, LooksAtNoMoreThan64KiB) {
  HandmadeExr file({1, 1, 32 * 1399});
  EXPECT_TRUE(ScanExrHeader(BytesOf(file.Build()), {}).ok());
  EXPECT_LT(file.Header().size(), kMaxHeaderBytes);
  HandmadeExr over({1, 1, 32 * 1401});
  const auto refused = ScanExrHeader(BytesOf(over.Build()), {});
  EXPECT_THAT(std::string(refused.status().message()), HasSubstr("use the bricks encoding"));
  HandmadeExr padded(kExtent);
  padded.Set("name", std::string(100'000, 'e'));
  EXPECT_EQ(ScanExrHeader(BytesOf(padded.Build()), {}).status().code(),
            absl::StatusCode::kInvalidArgument);
}

// 16384 x 16384 x 32 zeros: a file of some hundred kilobytes that decodes to 2 GiB.
TEST(ExrHeader, RefusesADecompressionBombBeforeItTakesMemory) {
  HandmadeExr bomb({16384, 16384, 32});
  bomb.Set("compression", "\3");
  bomb.Set("chunkCount", Bytes<int32_t>(1024));
  const VolumeLimits limits = {.max_decoded_bytes = uint64_t{1} << 30};
  const auto header = ScanExrHeader(BytesOf(bomb.Header()), limits);
  EXPECT_EQ(header.status().code(), absl::StatusCode::kResourceExhausted) << header.status();
  EXPECT_THAT(std::string(header.status().message()), HasSubstr("2147483648 bytes"));
}

TEST(ExrHeader, RefusesChunksThatTheFormatCannotHold) {
  HandmadeExr file({1, 1, 1});
  file.Set("bccExtent", Bytes<int32_t>(1 << 22, 4, 32 * 200));
  const VolumeLimits limits = {.max_decoded_bytes = std::numeric_limits<uint64_t>::max()};
  EXPECT_THAT(std::string(ScanExrHeader(BytesOf(file.Header()), limits).status().message()),
              HasSubstr("over the format's limit"));
}

}  // namespace
}  // namespace bccskel
