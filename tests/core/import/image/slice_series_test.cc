// Folders with a file for each slice.
#include "core/import/image/slice_series.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/import/image/image_folder.h"
#include "tests/core/import/image/png_bytes.h"
#include "tests/core/import/image/tiff_bytes.h"

namespace bccskel {
namespace {

using testing::CountedTo;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::ImageFolder;
using testing::PngBytes;
using testing::TiffBytes;

// The slice whose values count on from 6 z.
std::string PngSlice(uint16_t z, int bits = 8) {
  std::vector<uint16_t> samples;
  for (uint16_t n = 0; n < 6; ++n) samples.push_back(static_cast<uint16_t>(6 * z + n));
  return PngBytes({.bits = bits, .samples = samples});
}

std::string TiffSlices(int z, int count = 1) {
  return TiffBytes({.count = count, .height = 2, .first = static_cast<uint8_t>(6 * z)});
}

TEST(SliceSeries, StacksSlicesByTheirNumbers) {
  const ImageFolder folder("series");
  for (uint16_t z = 0; z < 12; ++z) {
    folder.Write("mask" + std::to_string(z + 7) + ".png", PngSlice(z));
  }
  folder.Write("notes.txt", "a scan");
  folder.Write("._mask7.png", "what macOS leaves");
  folder.Write("preview/mask1.png", "below");
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.size, (ImageSize{3, 2, 12}));
  EXPECT_EQ(image.info.format, "PNG");
  EXPECT_EQ(image.values, CountedTo(72));
}

TEST(SliceSeries, StacksTiffSlicesWithTheSpacingOfTheOptions) {
  const ImageFolder folder("tiffs");
  for (uint8_t z = 0; z < 3; ++z) folder.Write("s_0" + std::to_string(z) + ".TIF", TiffSlices(z));
  ImageOptions options;
  options.spacing = {1, 1, 2.5};
  const auto image = MustRead(folder.Read(options));
  EXPECT_EQ(image.values, CountedTo(18));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 1, 2.5));
}

TEST(SliceSeries, OfOneFileIsThatFile) {
  const ImageFolder folder("one_file");
  folder.Write("stack.tif", TiffSlices(0, 4));
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.values, CountedTo(24));
}

TEST(SliceSeries, CountsByTheOneNumberThatDiffers) {
  const auto order = [](std::vector<std::string> names) {
    std::ranges::sort(names);
    const auto ordered = InOrderOfNumbers(std::move(names));
    return ordered.ok() ? *ordered : std::vector<std::string>{ordered.status().ToString()};
  };
  EXPECT_THAT(order({"2024-01-31_z9.png", "2024-01-31_z10.png", "2024-01-31_z11.png"}),
              ElementsAre("2024-01-31_z9.png", "2024-01-31_z10.png", "2024-01-31_z11.png"));
  EXPECT_THAT(order({"10.png", "20.png", "30.png", "100.png", "40.png", "50.png", "60.png",
                     "70.png", "80.png", "90.png"})
                  .back(),
              "100.png");
  EXPECT_THAT(order({"09_x2.tif", "10_x2.tif"}), ElementsAre("09_x2.tif", "10_x2.tif"));
  EXPECT_THAT(order({"b.png"}), ElementsAre("b.png"));
}

TEST(SliceSeries, RefusesNamesThatAreNoSeries) {
  const auto error = [](std::vector<std::string> names) {
    std::ranges::sort(names);
    return std::string(InOrderOfNumbers(std::move(names)).status().message());
  };
  EXPECT_THAT(error({"s1.png", "s2.png", "s4.png"}),
              HasSubstr("'s4.png' follows 's2.png', but 's1.png' is followed by 's2.png': slices "
                        "are missing"));
  EXPECT_THAT(error({"s1.png", "s01.png"}), HasSubstr("have the same number"));
  EXPECT_THAT(error({"mask_1.png", "raw_1.png"}),
              HasSubstr("'mask_1.png' and 'raw_1.png' are not slices of one image"));
  EXPECT_THAT(error({"t1_z1.png", "t1_z2.png", "t2_z1.png", "t2_z2.png"}),
              HasSubstr("must be alike but for one number"));
  EXPECT_THAT(error({"a.png", "a1.png"}), HasSubstr("'a.png' and 'a1.png' are not slices"));
  EXPECT_THAT(error({"s1.png", "s2.tif", "s3.tiff"}), HasSubstr("holds 1 PNG and 2 TIFF files"));
}

TEST(SliceSeries, NamesTheSliceThatIsDamagedOrUnlikeTheFirst) {
  const ImageFolder folder("unlike");
  folder.Write("s1.png", PngSlice(0));
  folder.Write("s2.png", PngBytes({.width = 2, .samples = {0, 1, 2, 3}}));
  EXPECT_THAT(ErrorOf(folder),
              HasSubstr("slice 's2.png': has 2 x 2 pixels of uint8, the first one, 's1.png', has 3 "
                        "x 2 pixels of uint8; all must be alike"));
  folder.Write("s2.png", PngSlice(1, 16));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("slice 's2.png': has 3 x 2 pixels of uint16"));
  folder.Write("s2.png", PngSlice(1).substr(0, 50));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("slice 's2.png': the pixels cannot be read"));
  folder.Write("s1.png", "text");
  EXPECT_THAT(ErrorOf(folder), HasSubstr("slice 's1.png': format not supported"));
}

TEST(SliceSeries, RefusesSeveralFilesOfSeveralSlices) {
  const ImageFolder folder("stacks");
  for (uint8_t n = 1; n < 3; ++n) {
    folder.Write("s" + std::to_string(n) + ".tif", TiffSlices(0, 2));
  }
  EXPECT_THAT(ErrorOf(folder), HasSubstr("slice 's1.tif': holds 2 slices; each of several files"));
}

TEST(SliceSeries, RefusesMoreSlicesThanTheLimit) {
  const ImageFolder folder("limit");
  for (uint16_t z = 0; z < 5; ++z) folder.Write(std::to_string(z) + ".png", PngSlice(z));
  ImageOptions options;
  options.limits.max_axis_voxels = 4;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("axis 2 holds 5 voxels, the limit is 4"));
}

}  // namespace
}  // namespace bccskel
