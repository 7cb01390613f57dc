#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <string>
#include <vector>

#include "core/io/volume_decoder.h"
#include "core/io/volume_encoder.h"
#include "core/mask/mask_converter.h"
#include "tests/core/io/handmade_exr.h"
#include "tests/core/io/test_volumes.h"
#include "tests/support/volume_headers.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

struct Voxels {
  MaskGrid grid;
  std::vector<bool> inside;  // x fastest
};

Voxels RandomVoxels(MaskGrid grid, double share) {
  std::mt19937 random(7);
  std::bernoulli_distribution object(share);
  Voxels voxels = {grid, std::vector<bool>(grid.VoxelsPerSlice() * static_cast<size_t>(grid.nz))};
  for (size_t n = 0; n < voxels.inside.size(); ++n) voxels.inside[n] = object(random);
  return voxels;
}

// Bit n % 8 of byte n / 8 is voxel n.
std::string Packed(const Voxels& voxels) {
  std::string bytes((voxels.inside.size() + 7) / 8, '\0');
  for (size_t n = 0; n < voxels.inside.size(); ++n) {
    if (voxels.inside[n]) bytes[n / 8] = static_cast<char>(bytes[n / 8] | 1 << n % 8);
  }
  return bytes;
}

ConvertedMask Converted(const Voxels& voxels, MaskAdjacency adjacency,
                        VoxelPoints points = VoxelPoints::kTwo) {
  auto converter = MaskConverter::Create(voxels.grid, {.adjacency = adjacency, .points = points});
  const auto nx = static_cast<size_t>(voxels.grid.nx), ny = static_cast<size_t>(voxels.grid.ny);
  for (size_t z = 0, n = 0; z < static_cast<size_t>(voxels.grid.nz); ++z) {
    std::vector<uint64_t> words(voxels.grid.WordsPerSlice());
    for (size_t y = 0; y < ny; ++y) {
      for (size_t x = 0; x < nx; ++x, ++n) {
        const size_t word = y * voxels.grid.WordsPerRow() + x / 64;
        if (voxels.inside[n]) words[word] |= uint64_t{1} << x % 64;
      }
    }
    EXPECT_TRUE(converter->AddSlice(words, {}).ok());
  }
  return *std::move(*converter).Finish();
}

struct Decoded {
  Volume volume;
  std::optional<BettiNumbers> mask;
};

absl::StatusOr<Decoded> Decode(const VolumeHeader& header, const std::string& bytes,
                               size_t chunk_bytes) {
  auto decoder = MakeVolumeDecoder(header, {});
  if (!decoder.ok()) return decoder.status();
  for (size_t offset = 0; offset < bytes.size(); offset += chunk_bytes) {
    const absl::Status status = (*decoder)->Append(BytesOf(bytes.substr(offset, chunk_bytes)));
    if (!status.ok()) return status;
  }
  absl::StatusOr<Volume> volume = (*decoder)->Finish();
  if (!volume.ok()) return volume.status();
  return Decoded{*std::move(volume), (*decoder)->mask_topology()};
}

// Slices that begin inside bytes, that lie within one byte, and rows longer than a word.
const MaskGrid kGrids[] = {{.nx = 1, .ny = 1, .nz = 1},  {.nx = 1, .ny = 1, .nz = 37},
                           {.nx = 3, .ny = 1, .nz = 11}, {.nx = 5, .ny = 3, .nz = 7},
                           {.nx = 64, .ny = 2, .nz = 3}, {.nx = 71, .ny = 9, .nz = 5},
                           {.nx = 129, .ny = 4, .nz = 4}};

TEST(MaskEncoding, DecodesToTheConversionOfItsVoxels) {
  for (const MaskGrid& grid : kGrids) {
    for (MaskAdjacency adjacency : {MaskAdjacency::k26, MaskAdjacency::k6}) {
      const Voxels voxels = RandomVoxels(grid, 0.4);
      const VoxelPoints points = grid.nx % 2 == 0 ? VoxelPoints::kSixteen : VoxelPoints::kTwo;
      const ConvertedMask expected = Converted(voxels, adjacency, points);
      const auto header = test::MakeMaskHeader({grid, adjacency, points}, {});
      ASSERT_TRUE(header.ok()) << header.status();
      for (const size_t chunk_bytes : {1U, 3U, 1000U}) {
        const auto decoded = Decode(*header, Packed(voxels), chunk_bytes);
        ASSERT_TRUE(decoded.ok()) << decoded.status();
        EXPECT_EQ(decoded->volume, expected.volume) << grid.nx << ' ' << grid.ny << ' ' << grid.nz;
        EXPECT_EQ(decoded->mask, expected.mask);
      }
    }
  }
}

TEST(MaskEncoding, PlacesTheLatticeWhereTheVoxelsAre) {
  MaskGrid grid = {.nx = 4, .ny = 4, .nz = 4};
  grid.placement = {.spacing = {2, 3, 5}, .origin = {10, 20, 30}};
  const auto header = test::MakeMaskHeader({grid, MaskAdjacency::k26}, {});
  EXPECT_EQ(header->extent, (LatticeExtent{5, 5, 5}));
  EXPECT_EQ(header->placement.ToWorld(1, 1, 1), (WorldPoint{10, 20, 30}));
  EXPECT_EQ(header->placement.ToWorld(3, 3, 3), (WorldPoint{12, 23, 35}));
  const auto fine = test::MakeMaskHeader({grid, MaskAdjacency::k26, VoxelPoints::kSixteen}, {});
  EXPECT_EQ(fine->extent, (LatticeExtent{9, 9, 9}));
  // The center of voxel (0, 0, 0) is the middle of its eight refined voxels.
  EXPECT_EQ(fine->placement.ToWorld(2, 2, 2), (WorldPoint{10, 20, 30}));
  EXPECT_EQ(fine->placement.ToWorld(6, 6, 6), (WorldPoint{12, 23, 35}));
}

TEST(MaskEncoding, RefusesTooFewAndTooManyBytes) {
  const Voxels voxels = RandomVoxels({.nx = 5, .ny = 5, .nz = 5}, 0.5);
  const auto header = test::MakeMaskHeader({voxels.grid, MaskAdjacency::k26}, {});
  const std::string packed = Packed(voxels);  // 125 bits: 16 bytes
  for (size_t length : {size_t{0}, size_t{1}, packed.size() - 1}) {
    const auto decoded = Decode(*header, packed.substr(0, length), 100);
    EXPECT_EQ(decoded.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(decoded.status().message()),
                HasSubstr("has 16 bytes: only " + std::to_string(length) + " were sent"));
  }
  const auto decoded = Decode(*header, packed + "x", 100);
  EXPECT_THAT(std::string(decoded.status().message()), HasSubstr("more were sent"));
}

TEST(MaskEncoding, RefusesBitsPastTheLastVoxel) {
  const Voxels voxels = RandomVoxels({.nx = 5, .ny = 5, .nz = 5}, 0.5);
  std::string packed = Packed(voxels);
  packed.back() = static_cast<char>(packed.back() | 1 << 5);
  const auto decoded =
      Decode(*test::MakeMaskHeader({voxels.grid, MaskAdjacency::k26}, {}), packed, 100);
  EXPECT_EQ(decoded.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(decoded.status().message()), HasSubstr("past the last voxel"));
}

TEST(MaskEncoding, HoldsTheNumberOfBricksThatWasDeclared) {
  const Voxels voxels = RandomVoxels({.nx = 40, .ny = 40, .nz = 40}, 0.5);
  const MaskDeclaration mask = {voxels.grid, MaskAdjacency::k26};
  const uint64_t bricks = Converted(voxels, mask.adjacency).volume.brick_count();
  const auto enough = test::MakeMaskHeader(mask, {}, VolumeCompression::kNone, bricks);
  EXPECT_TRUE(Decode(*enough, Packed(voxels), 100).ok());
  const auto fewer = test::MakeMaskHeader(mask, {}, VolumeCompression::kNone, bricks - 1);
  EXPECT_EQ(Decode(*fewer, Packed(voxels), 100).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(MaskHeader, ChecksGridAndLimits) {
  const auto code = [](int32_t nx, const VolumeLimits& limits) {
    const MaskGrid grid = {.nx = nx, .ny = 10, .nz = 10};
    return test::MakeMaskHeader({grid, MaskAdjacency::k26}, limits).status().code();
  };
  EXPECT_EQ(code(10, {}), absl::StatusCode::kOk);
  EXPECT_EQ(code(0, {}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code(kMaxMaskVoxels + 1, {}), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(code(10, {.max_decoded_bytes = 125}), absl::StatusCode::kOk);
  EXPECT_EQ(code(10, {.max_decoded_bytes = 124}), absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(code(10, {.max_extent_cells = 10}), absl::StatusCode::kResourceExhausted);
}

TEST(MaskHeader, IsNoHeaderForWriting) {
  EXPECT_EQ(EncodeVolume(CornerVolume({17, 5, 33}), {.encoding = VolumeEncoding::kCubicMask,
                                                     .compression = VolumeCompression::kNone})
                .status()
                .code(),
            absl::StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace bccskel
