// Pictures written by libpng, some damaged afterwards.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "tests/core/import/image/image_bytes.h"
#include "tests/core/import/image/png_bytes.h"

namespace bccskel {
namespace {

using testing::CountedTo;
using ::testing::ElementsAre;
using testing::ErrorOfBytes;
using ::testing::HasSubstr;
using testing::PngBytes;
using testing::ReadBytes;

TEST(Png, KeepsGrayLevelsAndPaletteIndicesOfAllBits) {
  for (const int color : {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_PALETTE}) {
    for (const int bits : {1, 2, 4, 8, 16}) {
      if (color == PNG_COLOR_TYPE_PALETTE && bits == 16) continue;
      const auto most = static_cast<uint16_t>((1 << bits) - 1);
      const auto other = static_cast<uint16_t>(most / 3);
      const auto image = MustRead(ReadBytes(
          PngBytes({.bits = bits, .color = color, .samples = {0, most, 0, other, 0, most}})));
      EXPECT_EQ(image.info.format, "PNG");
      EXPECT_EQ(image.info.size, (ImageSize{3, 2, 1}));
      EXPECT_EQ(image.info.type, bits == 16 ? VoxelType::kUint16 : VoxelType::kUint8);
      EXPECT_THAT(image.values, ElementsAre(0, most, 0, other, 0, most)) << bits;
    }
  }
}

TEST(Png, ReadsTheSameWhetherInterlacedOrNot) {
  std::vector<uint16_t> samples(size_t{19} * 11);
  for (size_t n = 0; n < samples.size(); ++n) samples[n] = static_cast<uint16_t>(n);
  for (const int interlace : {PNG_INTERLACE_NONE, PNG_INTERLACE_ADAM7}) {
    const auto image = MustRead(ReadBytes(
        PngBytes({.width = 19, .height = 11, .interlace = interlace, .samples = samples})));
    EXPECT_EQ(image.values, CountedTo(19 * 11));
  }
}

TEST(Png, TakesColorsThatAreGrayAndOpaque) {
  for (const int bits : {8, 16}) {
    const auto most = static_cast<uint16_t>((1 << bits) - 1);
    const std::vector<testing::PngPicture> pictures = {
        {2, 1, bits, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, {7, 7, 7, most, most, most}},
        {2,
         1,
         bits,
         PNG_COLOR_TYPE_RGBA,
         PNG_INTERLACE_NONE,
         {7, 7, 7, most, most, most, most, most}},
        {2, 1, bits, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_ADAM7, {7, most, most, most}}};
    for (const testing::PngPicture& picture : pictures) {
      const auto image = MustRead(ReadBytes(PngBytes(picture)));
      EXPECT_THAT(image.values, ElementsAre(7, most)) << bits;
    }
  }
}

TEST(Png, RefusesColorsAndTransparencyWithTheirPlace) {
  EXPECT_THAT(ErrorOfBytes(PngBytes(
                  {.width = 1, .color = PNG_COLOR_TYPE_RGB, .samples = {5, 5, 5, 255, 255, 254}})),
              HasSubstr("pixel (0, 1) has the color 255, 255, 254; masks and labels are read from "
                        "gray levels or the indices of a palette: save the image as gray"));
  EXPECT_THAT(
      ErrorOfBytes(
          PngBytes({.width = 1, .color = PNG_COLOR_TYPE_GRAY_ALPHA, .samples = {5, 255, 5, 0}})),
      HasSubstr("pixel (0, 1) is transparent (alpha 0), so its value is not certain: remove "
                "the transparency (ImageMagick: convert IN.png -background black -alpha "
                "remove -alpha off OUT.png), or, if it is the mask, take it (-alpha extract)"));
  EXPECT_THAT(ErrorOfBytes(PngBytes({.width = 1, .samples = {5, 7}, .clear = 7})),
              HasSubstr("pixel (0, 1) is transparent (alpha 0)"));
  EXPECT_TRUE(ReadBytes(PngBytes({.width = 1, .samples = {5, 7}, .clear = 0})).ok());
}

TEST(Png, TransparentBlackIsBackground) {
  const auto image = MustRead(ReadBytes(PngBytes({.width = 2,
                                                  .height = 1,
                                                  .color = PNG_COLOR_TYPE_RGBA,
                                                  .samples = {0, 0, 0, 0, 255, 255, 255, 255}})));
  EXPECT_THAT(image.values, ElementsAre(0, 255));
  EXPECT_THAT(ErrorOfBytes(PngBytes({.width = 2,
                                     .height = 1,
                                     .color = PNG_COLOR_TYPE_RGBA,
                                     .samples = {0, 0, 0, 0, 0, 0, 0, 110}})),
              HasSubstr("pixel (1, 0) is transparent (alpha 110)"));
  EXPECT_THAT(ErrorOfBytes(PngBytes({.width = 2,
                                     .height = 2,
                                     .color = PNG_COLOR_TYPE_GRAY_ALPHA,
                                     .samples = {255, 255, 0, 0, 0, 255, 255, 255}})),
              HasSubstr("pixel (1, 0) is transparent (alpha 0)"));
}

TEST(Png, ReadsAFileCompressedByGzipAsAWhole) {
  const std::string bytes = PngBytes({.samples = {0, 1, 2, 3, 4, 5}});
  const auto image = MustRead(ReadBytes(testing::Deflated(bytes, testing::Wrapping::kGzip)));
  EXPECT_EQ(image.values, CountedTo(6));
}

TEST(Png, HasTheSpacingOfTheOptions) {
  ImageOptions options;
  options.spacing = {2, 3, 4};
  const auto image = MustRead(ReadBytes(PngBytes({.samples = {0, 1, 2, 3, 4, 5}}), options));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(2, 3, 4));
}

TEST(Png, RefusesEveryCutAndEveryChangedByte) {
  const std::string bytes =
      PngBytes({.color = PNG_COLOR_TYPE_PALETTE, .samples = {0, 1, 2, 3, 4, 5}});
  for (size_t size = 8; size < bytes.size(); ++size) {
    EXPECT_FALSE(ReadBytes(bytes.substr(0, size)).ok()) << size;
  }
  for (size_t at = 8; at < bytes.size(); ++at) {
    std::string changed = bytes;
    changed[at] = static_cast<char>(changed[at] ^ 0x10);
    EXPECT_FALSE(ReadBytes(changed).ok()) << at;
  }
  EXPECT_THAT(ErrorOfBytes(bytes.substr(0, bytes.size() - 20)),
              HasSubstr("the pixels cannot be read: the file is cut"));
  std::string changed = bytes;
  changed[changed.size() - 13] ^= 1;  // the check sum of IDAT, before IEND
  EXPECT_THAT(ErrorOfBytes(changed), HasSubstr("IDAT: CRC error"));
}

// With the width and height that IHDR declares, and its check sum made to agree.
std::string Declaring(std::string bytes, uint32_t width, uint32_t height) {
  const auto put = [&bytes](size_t at, uint32_t number) {
    bytes.replace(at, 4, testing::Bytes(number, std::endian::big));
  };
  put(16, width);
  put(20, height);
  const auto* const checked = reinterpret_cast<const Bytef*>(bytes.data() + 12);
  put(29, static_cast<uint32_t>(crc32(0, checked, 17)));
  return bytes;
}

TEST(Png, RefusesSizesThatTheFileCannotHoldBeforeItTakesMemory) {
  const std::string bytes = PngBytes({.samples = {0, 1, 2, 3, 4, 5}});
  EXPECT_THAT(ErrorOfBytes(Declaring(bytes, 30000, 30000)),
              HasSubstr("30000 x 30000 pixels declare 900000000 bytes; the file of "));
  EXPECT_THAT(ErrorOfBytes(Declaring(bytes, 1000000, 1000000)), HasSubstr("the limit is"));
  EXPECT_THAT(ErrorOfBytes(Declaring(bytes, 0x7fffffff, 1)), HasSubstr("the limit is"));
  EXPECT_THAT(ErrorOfBytes(Declaring(bytes, 0, 1)), HasSubstr("the header cannot be read"));
}

TEST(Png, RefusesJpegAndBmpAndNamesFormatsToUse) {
  EXPECT_THAT(ErrorOfBytes("\xff\xd8\xff\xe0 JFIF"),
              HasSubstr("JPEG is not supported: it changes"));
  EXPECT_THAT(ErrorOfBytes("BM      "),
              HasSubstr("save another image as NIfTI or NRRD, which keep its place"));
}

}  // namespace
}  // namespace bccskel
