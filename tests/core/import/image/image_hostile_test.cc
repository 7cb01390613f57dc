// The reference volumes with their numbers of voxels, and the hostile files with their ends.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/import/image/foreground.h"
#include "tests/core/import/image/image_bytes.h"

namespace bccskel {
namespace {

using ::testing::HasSubstr;

const std::filesystem::path kVolumes = BCCSKEL_TEST_DATA_DIR "/volume";
const std::filesystem::path kHostile = BCCSKEL_TEST_DATA_DIR "/hostile";

absl::StatusOr<uint64_t> CountForeground(const std::string& path, const ForegroundRule& rule) {
  const auto source = OpenImage(path);
  if (!source.ok()) return source.status();
  const ImageSize& size = (*source)->info().size;
  std::vector<uint64_t> words(WordsPerRow(size.nx) * static_cast<size_t>(size.ny));
  uint64_t count = 0;
  for (int32_t z = 0; z < size.nz; ++z) {
    const auto slice = (*source)->NextSlice();
    if (!slice.ok()) return slice.status();
    ForegroundSlice(*slice, rule, words);
    for (const uint64_t word : words) count += static_cast<uint64_t>(std::popcount(word));
  }
  return count;
}

struct Volume {
  const char* file;
  ForegroundRule rule;
  ImageSize size;
  VoxelType type;
  std::array<double, 3> spacing;
  uint64_t voxels;
};

std::vector<Volume> Volumes() {
  const auto non_zero = ForegroundRule::NonZero();
  constexpr auto kU8 = VoxelType::kUint8;
  return {
      {"airway_p4_chopped.nrrd", non_zero, {311, 274, 362}, kU8, {1, 1, 1}, 485117},
      {"neuron_28648864.nrrd", non_zero, {215, 512, 313}, kU8, {16, 16, 40}, 335259},
      {"neuron_28018323.nrrd", non_zero, {365, 400, 175}, kU8, {16, 16, 40}, 384708},
      {"neuron_28794499.nrrd", non_zero, {326, 512, 130}, kU8, {16, 16, 40}, 1446575},
      {"Al.100.vol", non_zero, {100, 100, 100}, kU8, {1, 1, 1}, 70413},
      {"cat10b.vol", non_zero, {44, 44, 44}, kU8, {1, 1, 1}, 8043},
      {"lobster.vol", *ForegroundRule::From(40), {301, 324, 56}, kU8, {1, 1, 1}, 269432},
      {"lobsterCroped2.nii.gz", *ForegroundRule::From(40), {101, 101, 41}, kU8, {1, 1, 1}, 50899},
      {"liver.inr.gz",
       *ForegroundRule::Labels({127}),
       {438, 353, 165},
       kU8,
       {0.617188, 0.617188, 1.33333},
       314086},
      {"liver.inr.gz",
       *ForegroundRule::Labels({85}),
       {438, 353, 165},
       kU8,
       {0.617188, 0.617188, 1.33333},
       17702},
      {"liver.inr.gz", non_zero, {438, 353, 165}, kU8, {0.617188, 0.617188, 1.33333}, 3492286},
      {"poon2015_BBB_noLeakage_manualLabel_v2.tif",
       non_zero,
       {512, 512, 25},
       kU8,
       {1, 1, 1},
       242943},
      {"santos2015_lowContrastVessels_labelsMarc.tif",
       non_zero,
       {512, 512, 15},
       VoxelType::kUint16,
       {1, 1, 1},
       458204},
      {"100_fiberform.tif", *ForegroundRule::From(90), {100, 100, 100}, kU8, {1, 1, 1}, 167140},
      {"100_fiberform.tif", *ForegroundRule::From(104), {100, 100, 100}, kU8, {1, 1, 1}, 157908},
      {"aorta-final-levelset.mha",
       *ForegroundRule::Below(0),
       {157, 393, 34},
       VoxelType::kFloat32,
       {0.878906, 0.878906, 1.50009},
       11590},
  };
}

TEST(ReferenceVolumes, HaveTheVoxelsThatOthersCounted) {
  if (!std::filesystem::is_directory(kVolumes)) GTEST_SKIP() << "no " << kVolumes;
  for (const Volume& volume : Volumes()) {
    const std::string path = kVolumes / volume.file;
    const auto source = OpenImage(path);
    ASSERT_TRUE(source.ok()) << source.status();
    const ImageInfo& info = (*source)->info();
    EXPECT_EQ(info.size, volume.size) << volume.file;
    EXPECT_EQ(info.type, volume.type) << volume.file;
    for (size_t axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(info.placement.spacing[axis], volume.spacing[axis], 1e-9) << volume.file;
    }
    const auto count = CountForeground(path, volume.rule);
    ASSERT_TRUE(count.ok()) << count.status();
    EXPECT_EQ(*count, volume.voxels) << volume.file;
  }
}

// A file, and its end: the number of its voxels, or a part of the error's message.
struct End {
  const char* file;
  std::optional<uint64_t> voxels;
  const char* message;
};
constexpr End kEnds[] = {
    {"all_zero.nrrd", 0, ""},
    {"all_one.nrrd", 512, ""},
    {"single_voxel.nrrd", 1, ""},
    {"one_by_one.nrrd", 1, ""},
    {"short_data.nrrd", std::nullopt, "the file has 512 bytes for them"},
    {"sizes_1e6_cubed.nrrd", std::nullopt, "the limit is"},
    {"sizes_overflow.nrrd", std::nullopt, "axis 0 holds 4294967296 voxels, the limit is 2097151"},
    {"sizes_negative.nrrd", std::nullopt, "axis 0 holds -8 voxels"},
    {"sizes_zero.nrrd", std::nullopt, "axis 0 holds 0 voxels"},
    {"four_dim.nrrd", std::nullopt, "4 axes (3 x 8 x 8 x 8)"},
    {"float_nan.nrrd", std::nullopt, "lacks 'endian'"},
    {"gzip_truncated.nrrd", std::nullopt, "cut after"},
    {"gzip_bomb.nrrd", std::nullopt, "holds more"},
    {"detached_path.nrrd", std::nullopt, "names '/etc/passwd'"},
    {"anisotropic_1000.nrrd", 0, ""},
    {"spacing_zero.nrrd", std::nullopt, "spacing 0 x 1 x 1"},
    {"fortran_order.npy", 0, ""},
    {"big_endian_u2.npy", 0, ""},
    {"pickle_object.npy", std::nullopt, "'|O'"},
    {"shape_overflow.npy", std::nullopt, "4000000000 voxels, the limit is"},
};

TEST(HostileVolumes, EndAsStated) {
  if (!std::filesystem::is_directory(kHostile)) GTEST_SKIP() << "no " << kHostile;
  for (const End& end : kEnds) {
    const auto count = CountForeground(kHostile / end.file, ForegroundRule::NonZero());
    EXPECT_EQ(count.ok(), end.voxels.has_value()) << end.file << count.status();
    if (count.ok() && end.voxels.has_value() && *end.voxels > 0) {
      EXPECT_EQ(*count, *end.voxels) << end.file;
    }
    if (!count.ok()) {
      EXPECT_THAT(std::string(count.status().message()), HasSubstr(end.message)) << end.file;
    }
  }
}

TEST(HostileVolumes, AreAllStated) {
  if (!std::filesystem::is_directory(kHostile)) GTEST_SKIP() << "no " << kHostile;
  std::set<std::string> stated, present;
  for (const End& end : kEnds) stated.insert(end.file);
  for (const auto& entry : std::filesystem::directory_iterator(kHostile)) {
    if (IsImagePath(entry.path().string())) present.insert(entry.path().filename());
  }
  EXPECT_EQ(stated, present);
}

TEST(HostileVolumes, KeepTheirValidNeighbors) {
  if (!std::filesystem::is_directory(kHostile)) GTEST_SKIP() << "no " << kHostile;
  const auto big_endian = MustRead(testing::ReadAll(OpenImage(kHostile / "big_endian_u2.npy")));
  EXPECT_EQ(big_endian.info.size, (ImageSize{5, 4, 3}));
  const auto fortran = MustRead(testing::ReadAll(OpenImage(kHostile / "fortran_order.npy")));
  EXPECT_EQ(fortran.info.size, (ImageSize{5, 4, 3}));
}

}  // namespace
}  // namespace bccskel
