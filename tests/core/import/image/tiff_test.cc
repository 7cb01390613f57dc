// TIFF pages written by libtiff and damaged afterwards. Files of other writers:
// foreign_images_test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tiffio.h>

#include <string>
#include <vector>

#include "tests/core/import/image/image_bytes.h"
#include "tests/core/import/image/tiff_bytes.h"

namespace bccskel {
namespace {

using testing::CountedTo;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;
using testing::ReadBytes;
using testing::TiffBytes;

TEST(Tiff, StacksPagesOfEveryCompression) {
  for (const int compression :
       {COMPRESSION_NONE, COMPRESSION_LZW, COMPRESSION_PACKBITS, COMPRESSION_ADOBE_DEFLATE}) {
    const auto image = MustRead(ReadBytes(TiffBytes({.compression = compression})));
    EXPECT_EQ(image.info.size, (ImageSize{3, 4, 2}));
    EXPECT_EQ(image.values, CountedTo(24));
  }
}

// libtiff cannot write the compressions that it does not know.
std::string WithCompression(std::string bytes, int compression) {
  const std::string tag("\3\1\3\0\1\0\0\0", 8);  // 259, one SHORT
  for (size_t at = bytes.find(tag); at != bytes.npos; at = bytes.find(tag, at + 1)) {
    bytes[at + 8] = static_cast<char>(compression & 0xff);
    bytes[at + 9] = static_cast<char>(compression >> 8);
  }
  return bytes;
}

TEST(Tiff, SaysWhatToDoWithACompressionThatItDoesNotRead) {
  const auto error = [](int compression) {
    return std::string(ReadBytes(WithCompression(TiffBytes({}), compression)).status().message());
  };
  for (const int jpeg_2000 : {33003, 33004, 33005, 34712}) {
    EXPECT_THAT(error(jpeg_2000), HasSubstr("JPEG 2000 compression (" + std::to_string(jpeg_2000) +
                                            ") is not supported; `bfconvert -compression LZW`"));
  }
  EXPECT_THAT(error(50013), HasSubstr("its compression (50013) is not supported"));
}

TEST(Tiff, GivesBilevelPagesAsZeroAndOne) {
  // Rows of bytes 0, 1, 2, 3: the highest bit is the first pixel.
  const auto image = MustRead(ReadBytes(TiffBytes({.count = 1, .width = 8, .bits = 1})));
  EXPECT_EQ(std::vector<double>(image.values.begin() + 24, image.values.end()),
            (std::vector<double>{0, 0, 0, 0, 0, 0, 1, 1}));
}

// As tifffile reads them: a mask of few voxels stays one, and the background of labels is 0.
TEST(Tiff, KeepsStoredValuesWhereWhiteIsZero) {
  for (const int bits : {1, 8, 16}) {
    const auto black = ReadBytes(TiffBytes({.count = 1, .width = 8, .bits = bits}));
    const auto white = ReadBytes(
        TiffBytes({.count = 1, .width = 8, .bits = bits, .photometric = PHOTOMETRIC_MINISWHITE}));
    ASSERT_TRUE(black.ok()) << black.status();
    ASSERT_TRUE(white.ok()) << white.status();
    EXPECT_EQ(white->values, black->values) << bits;
  }
}

std::string Ome(const std::string& pixels) {
  return "<?xml version=\"1.0\"?><OME xmlns=\"x\"><Image><Pixels ID=\"Pixels:0\" " + pixels +
         "/></Image></OME>";
}

ImageOptions Channel(int64_t number) {
  ImageOptions options;
  options.channel = number;
  return options;
}

ImageOptions Time(int64_t number) {
  ImageOptions options;
  options.time = number;
  return options;
}

// The pages that the slices come from: each page's first value is 12 times its number.
std::string PagesOf(const std::string& description, const ImageOptions& options, int count = 6) {
  const auto image =
      ReadBytes(TiffBytes({.count = count, .description = description.c_str()}), options);
  if (!image.ok()) return std::string(image.status().message());
  std::string pages;
  for (size_t n = 0; n < image->values.size(); n += 12) {
    pages += std::to_string(static_cast<int>(image->values[n]) / 12);
  }
  return pages;
}

TEST(Tiff, ChoosesAChannelAndAPointOfTime) {
  const std::string zct = Ome("DimensionOrder=\"XYZCT\" SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\"");
  const std::string czt = Ome("DimensionOrder=\"XYCZT\" SizeZ=\"3\" SizeC=\"2\" SizeT=\"1\"");
  const std::string times = Ome("DimensionOrder=\"XYZTC\" SizeZ=\"2\" SizeC=\"1\" SizeT=\"3\"");
  EXPECT_THAT(PagesOf(zct, {}), HasSubstr("2 channels; choose one with --channel 0 to 1"));
  EXPECT_EQ(PagesOf(zct, Channel(0)), "012");
  EXPECT_EQ(PagesOf(zct, Channel(1)), "345");
  EXPECT_EQ(PagesOf(czt, Channel(1)), "135");
  EXPECT_THAT(PagesOf(zct, Channel(2)), HasSubstr("channel 2 is not there"));
  EXPECT_THAT(PagesOf(times, {}), HasSubstr("--time 0 to 2"));
  EXPECT_EQ(PagesOf(times, Time(2)), "45");
  EXPECT_EQ(PagesOf("ImageJ=1.53\nimages=6\nchannels=2\nslices=3\n", Channel(1)), "135");
  EXPECT_EQ(PagesOf("{\"axes\": \"CZYX\", \"shape\": [2, 3, 4, 3]}", Channel(1)), "345");
  EXPECT_EQ(PagesOf("{\"shape\": [2, 3, 4, 3]}", Channel(1)), "345");
  EXPECT_EQ(PagesOf("{\"shape\": [6, 4, 3]}", {}), "012345");
  EXPECT_THAT(PagesOf("{\"shape\": [2, 3, 4, 3]}", {}), HasSubstr("2 channels"));
  EXPECT_THAT(PagesOf("{\"axes\": \"TYX\", \"shape\": [6, 4, 3]}", {}), HasSubstr("6 times"));
  EXPECT_THAT(PagesOf("{\"axes\": \"QZYX\", \"shape\": [2, 3, 4, 3]}", {}), HasSubstr("axis Q"));
}

// As tifffile writes pred[..., None]; it drops the last axis of a page itself.
TEST(Tiff, DropsTrailingAxesOfLengthOne) {
  EXPECT_EQ(PagesOf("{\"shape\": [6, 4, 3, 1]}", {}), "012345");
  EXPECT_EQ(PagesOf("{\"shape\": [6, 4, 3, 1, 1]}", {}), "012345");
  EXPECT_EQ(PagesOf("{\"shape\": [2, 3, 4, 3, 1]}", Channel(1)), "345");
  EXPECT_EQ(PagesOf("{\"axes\": \"ZYXC\", \"shape\": [6, 4, 3, 1]}", {}), "012345");
  EXPECT_EQ(PagesOf("{\"shape\": [4, 3, 1]}", {}, 1), "0");
  EXPECT_EQ(PagesOf("{\"shape\": [6, 12, 1]}", {}), "012345") << "as wide as a voxel";
  EXPECT_THAT(PagesOf("{\"shape\": [6, 4, 3, 2]}", {}), HasSubstr("more than the 6 pages"));
}

TEST(Tiff, SaysHowToSaveSlicesThatAreNamedChannels) {
  const std::string hint = "if they are slices, save them as such";
  for (const std::string& description :
       {std::string("ImageJ=1.53\nimages=6\nchannels=6\n"),
        Ome("DimensionOrder=\"XYCZT\" SizeZ=\"1\" SizeC=\"6\" SizeT=\"1\""),
        std::string("{\"axes\": \"TYX\", \"shape\": [6, 4, 3]}")}) {
    EXPECT_THAT(PagesOf(description, {}),
                HasSubstr(hint + " (tifffile: metadata={'axes': 'ZYX'})"));
  }
  EXPECT_THAT(PagesOf("{\"shape\": [2, 3, 4, 3]}", {}), Not(HasSubstr(hint)));
}

TEST(Tiff, RefusesDescriptionsThatContradictThePages) {
  const std::string large =
      Ome("DimensionOrder=\"XYZCT\" SizeZ=\"4611686018427387904\" SizeC=\"4\" SizeT=\"4\"");
  EXPECT_THAT(PagesOf(large, {}), HasSubstr("more planes than the 6 pages"));
  EXPECT_THAT(PagesOf(Ome("DimensionOrder=\"XYZCT\" SizeZ=\"4\""), {}), HasSubstr("6 pages"));
  EXPECT_THAT(PagesOf(Ome("DimensionOrder=\"ZZZZZ\" SizeZ=\"6\""), {}), HasSubstr("ZZZZZ"));
  EXPECT_THAT(PagesOf("{\"shape\": [6, 4, 3]}", {}, 1), HasSubstr("truncate"));
  EXPECT_THAT(PagesOf("no description", Channel(1)), HasSubstr("names none"));
}

TEST(Tiff, TakesThePhysicalSizeOfOme) {
  const std::string description =
      Ome("DimensionOrder=\"XYZCT\" SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\" PhysicalSizeX=\"0.2\" "
          "PhysicalSizeY=\"0.25\" PhysicalSizeZ=\"1.5\" PhysicalSizeZUnit=\"\xc2\xb5m\"");
  const auto image = MustRead(ReadBytes(TiffBytes({.description = description.c_str()})));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(0.2, 0.25, 1.5));
  EXPECT_EQ(image.info.unit, "um");
}

TEST(Tiff, TakesWhatOmeStatesOfThePhysicalSizeAndNoResolutionTags) {
  const std::string pixels = "DimensionOrder=\"XYZCT\" SizeZ=\"2\" SizeC=\"1\" SizeT=\"1\" ";
  const auto spacing_of = [](const std::string& description) {
    const auto image = ReadBytes(TiffBytes({.description = description.c_str()}));
    EXPECT_TRUE(image.ok()) << image.status();
    return image.ok() ? image->info.placement.spacing : std::array<double, 3>{};
  };
  EXPECT_THAT(spacing_of(Ome(pixels + "PhysicalSizeZ=\"1.5\"")), ElementsAre(1, 1, 1.5));
  EXPECT_THAT(spacing_of(Ome(pixels + "PhysicalSizeY=\"0.2\"")), ElementsAre(0.2, 0.2, 1));
  EXPECT_THAT(spacing_of("<ome:OME xmlns:ome=\"x\"><ome:Image><ome:Pixels " + pixels +
                         "PhysicalSizeX=\"0.2\" PhysicalSizeZ=\"1.5\"/></ome:Image></ome:OME>"),
              ElementsAre(0.2, 0.2, 1.5));
}

TEST(Tiff, ConvertsTheUnitsOfImageJToOne) {
  const auto stack =
      MustRead(ReadBytes(TiffBytes({.description = "ImageJ=1.53\nimages=2\nslices=2\nunit=nm"
                                                   "\nzunit=um\nspacing=1.5\n"})));
  EXPECT_THAT(stack.info.placement.spacing, ElementsAre(0.25, 0.5, 1500));
  EXPECT_EQ(stack.info.unit, "nm");
}

TEST(Tiff, TakesSpacingAndUnitFromImageJOnly) {
  const auto plain = MustRead(ReadBytes(TiffBytes({})));
  EXPECT_THAT(plain.info.placement.spacing, ElementsAre(1, 1, 1));
  const auto printed =
      MustRead(ReadBytes(TiffBytes({.description = "ImageJ=1.53\nimages=2\nunit=inch\n"})));
  EXPECT_THAT(printed.info.placement.spacing, ElementsAre(1, 1, 1));
  const auto stack = MustRead(ReadBytes(TiffBytes(
      {.description = "ImageJ=1.53\nimages=2\nslices=2\nunit=micron\nspacing=1.5\nloop=false\n"})));
  EXPECT_THAT(stack.info.placement.spacing, ElementsAre(0.25, 0.5, 1.5));
  EXPECT_EQ(stack.info.unit, "um");
}

// ImageJ writes the sign of micro in three ways; other bytes than words would end up in results.
TEST(Tiff, KnowsTheUnitsOfImageJ) {
  const std::pair<const char*, const char*> units[] = {
      {"\\u00B5m", "um"}, {"\xb5m", "um"},    {"\xc2\xb5m", "um"}, {"um", "um"},
      {"nm", "nm"},       {"pixel", "pixel"}, {"\\u5149", ""},     {"a\"b", ""},
  };
  for (const auto& [written, read] : units) {
    const std::string description =
        std::string("ImageJ=1.53\nimages=2\nslices=2\nunit=") + written + "\nspacing=1.5\n";
    const auto stack = MustRead(ReadBytes(TiffBytes({.description = description.c_str()})));
    EXPECT_EQ(stack.info.unit, read);
    EXPECT_THAT(stack.info.placement.spacing, ElementsAre(0.25, 0.5, 1.5));
  }
}

TEST(Tiff, RefusesWhatIsNoStackOfNumbers) {
  const auto message = [](const std::string& bytes) {
    const auto image = ReadBytes(bytes);
    EXPECT_FALSE(image.ok());
    return std::string(image.status().message());
  };
  EXPECT_THAT(message(TiffBytes({.samples = 3, .photometric = PHOTOMETRIC_RGB})),
              HasSubstr("3 samples per pixel"));
  EXPECT_THAT(message(TiffBytes({.bits = 4})), HasSubstr("samples of 4 bits"));
  EXPECT_THAT(message(TiffBytes({.count = 3}, 5)), HasSubstr("slice 2"));
  EXPECT_THAT(message(TiffBytes({.description = "ImageJ=1.53\nimages=4\nchannels=2\n"})),
              HasSubstr("channels"));
  EXPECT_THAT(message(TiffBytes({.count = 1, .description = "ImageJ=1.53\nimages=4\n"})),
              HasSubstr("4 images"));
}

TEST(Tiff, EndsWellWhereverItIsCutOrChanged) {
  const std::string bytes = TiffBytes({.compression = COMPRESSION_LZW});
  for (size_t size = 4; size < bytes.size(); ++size) {
    const auto image = ReadBytes(bytes.substr(0, size));
    // Without its second page the stack is just shorter.
    if (image.ok()) {
      EXPECT_EQ(image->info.size.nz, 1) << size;
    }
  }
  for (size_t at = 0; at < bytes.size(); ++at) {
    for (const int byte : {0, 1, 127, 255}) {
      std::string changed = bytes;
      changed[at] = static_cast<char>(byte);
      ReadBytes(changed).IgnoreError();
    }
  }
}

}  // namespace
}  // namespace bccskel
