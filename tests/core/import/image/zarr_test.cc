// Zarr folders written by hand: what is chosen, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <vector>

#include "core/import/image/slice_buffer.h"
#include "tests/core/import/image/image_folder.h"

namespace bccskel {
namespace {

using ::testing::AllOf;
using testing::CountedTo;
using testing::Counting;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::ImageFolder;
using testing::ReadsOfDamaged;
using testing::Replaced;
using testing::Replacements;

// 2 x 3 x 4 voxels (z, y, x) in one chunk.
const std::string kArray =
    R"({"zarr_format":2,"shape":[2,3,4],"chunks":[2,3,4],"dtype":"|u1","compressor":null,)"
    R"("fill_value":0,"order":"C","filters":null})";

std::string Array(const Replacements& changes = {}) { return Replaced(kArray, changes); }

ImageOptions Choice(std::optional<int64_t> channel, std::optional<int64_t> time,
                    std::optional<int64_t> level) {
  ImageOptions options;
  options.channel = channel;
  options.time = time;
  options.level = level;
  return options;
}

std::string ErrorOfArray(const Replacements& changes) {
  const ImageFolder folder("array.zarr");
  folder.Write(".zarray", Array(changes));
  folder.Write("0.0.0", Counting<uint8_t>(24));
  return ErrorOf(folder);
}

std::string Multiscales(const std::string& members) {
  return R"({"multiscales":[{"version":"0.4",)" + members + "}]}";
}

const std::string kAxes = R"("axes":[{"name":"z","type":"space","unit":"micrometer"},)"
                          R"({"name":"y","type":"space","unit":"micrometer"},)"
                          R"({"name":"x","type":"space","unit":"micrometer"}])";
const std::string kDatasets = R"("datasets":[{"path":"0"},{"path":"a/1"}])";

TEST(Zarr, IsReadFromOneChunk) {
  const ImageFolder folder("plain.zarr");
  folder.Write(".zarray", Array());
  folder.Write("0.0.0", Counting<uint8_t>(24));
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.format, "Zarr");
  EXPECT_EQ(image.info.size, (ImageSize{4, 3, 2}));
  EXPECT_EQ(image.values, CountedTo(24));
}

TEST(Zarr, HasTheFillValueWhereChunksAreMissing) {
  const ImageFolder folder("missing.zarr");
  folder.Write(".zarray", Array({{"[2,3,4],\"dtype\":\"|u1\"", "[1,3,4],\"dtype\":\">i2\""},
                                 {"\"fill_value\":0", "\"fill_value\":-7"}}));
  folder.Write("1.0.0", Counting<int16_t>(12, std::endian::big));
  const auto image = MustRead(folder.Read());
  std::vector<double> expected(12, -7);
  for (int n = 0; n < 12; ++n) expected.push_back(n);
  EXPECT_EQ(image.values, expected);
}

TEST(Zarr, IsReadInSeveralGoesWhereASlabIsTooLarge) {
  const ImageFolder folder("slabs.zarr");
  folder.Write(".zarray", Array());
  folder.Write("0.0.0", Counting<uint8_t>(24));
  ImageOptions options;
  options.limits.max_chunk_slab_bytes = 12;
  const auto image = MustRead(folder.Read(options));
  EXPECT_EQ(image.values, CountedTo(24));
}

TEST(Zarr, ChoosesLevelChannelAndTime) {
  const ImageFolder folder("choice.ome.zarr");
  folder.Write(".zattrs", Multiscales(R"("axes":[{"name":"t"},{"name":"c"},{"name":"y"},)"
                                      R"({"name":"x"}],"datasets":[{"path":"0"},{"path":"1"}])"));
  // Both points of time in one chunk, both channels in chunks of their own.
  folder.Write("1/.zarray", Array({{"\"shape\":[2,3,4],\"chunks\":[2,3,4]",
                                    "\"shape\":[2,2,2,2],\"chunks\":[2,1,2,2]"}}));
  folder.Write("1/0.1.0.0", Counting<uint8_t>(8));
  EXPECT_THAT(ErrorOf(folder, Choice(1, 1, {})),
              HasSubstr("'0', which has neither .zarray nor zarr.json"));
  EXPECT_THAT(ErrorOf(folder, Choice({}, {}, 1)),
              HasSubstr("2 times; choose one with --time 0 to 1"));
  EXPECT_THAT(ErrorOf(folder, Choice({}, 0, 1)), HasSubstr("--channel 0 to 1"));
  EXPECT_THAT(ErrorOf(folder, Choice(2, 0, 1)),
              HasSubstr("channel 2 is not there: the image has 2"));
  EXPECT_THAT(ErrorOf(folder, Choice({}, {}, 2)),
              HasSubstr("level 2 is not there: the image has 2"));
  const auto image = MustRead(folder.Read(Choice(1, 1, 1)));
  EXPECT_EQ(image.info.size, (ImageSize{2, 2, 1}));
  EXPECT_THAT(image.values, ElementsAre(4, 5, 6, 7));
}

TEST(Zarr, LiesWhereItsTransformationsPlaceIt) {
  const ImageFolder folder("placed.ome.zarr");
  folder.Write(
      ".zattrs",
      Multiscales(kAxes + R"(,"datasets":[{"path":"a","coordinateTransformations":[)"
                          R"({"type":"scale","scale":[4,2,1]},)"
                          R"({"type":"translation","translation":[3,5,7]}]}],)"
                          R"("coordinateTransformations":[{"type":"scale","scale":[1,1,0.5]}])"));
  folder.Write("a/.zarray", Array());
  folder.Write("a/0.0.0", Counting<uint8_t>(24));
  auto image = folder.Read();
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ(image->info.format, "OME-Zarr");
  EXPECT_EQ(image->info.unit, "um");
  EXPECT_THAT(image->info.placement.spacing, ElementsAre(0.5, 2, 4));
  EXPECT_THAT(image->info.placement.origin, ElementsAre(3.5, 5, 3));
  ImageOptions options;
  options.spacing = {1, 2, 3};
  image = folder.Read(options);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_THAT(image->info.placement.spacing, ElementsAre(1, 2, 3));
}

TEST(Zarr, GivesHalfPrecisionAsFloats) {
  for (const char* const order : {"<f2", ">f2"}) {
    const ImageFolder folder("halves.zarr");
    folder.Write(".zarray", Array({{"|u1", order},
                                   {"\"shape\":[2,3,4]", "\"shape\":[4,3,4]"},
                                   {"\"fill_value\":0", "\"fill_value\":-2.1"}}));
    std::string voxels;
    for (const int half : {0x0000, 0x3c00, 0xbe00, 0x7bff, 0x0001, 0x8400, 0xfc00, 0x7e01}) {
      voxels += testing::Bytes(static_cast<uint16_t>(half),
                               order[0] == '<' ? std::endian::little : std::endian::big);
    }
    folder.Write("0.0.0", voxels + voxels + voxels);
    const auto image = MustRead(folder.Read());
    EXPECT_EQ(image.info.type, VoxelType::kFloat32);
    ASSERT_EQ(image.values.size(), 48);
    EXPECT_THAT(std::vector<double>(image.values.begin(), image.values.begin() + 8),
                ElementsAre(0, 1, -1.5, 65504, 0x1p-24, -0x1p-14, -HUGE_VAL, ::testing::IsNan()));
    EXPECT_EQ(image.values.back(), -2.099609375);  // the missing chunk
  }
}

TEST(Zarr, RoundsFillValuesOfHalfPrecision) {
  for (uint32_t half = 0; half < 0x7c00; half += 77) {
    for (const uint32_t sign : {0U, 0x8000U}) {
      SliceBuffer buffer;
      buffer.Resize(VoxelType::kUint16, 1);
      const auto stored = static_cast<uint16_t>(half | sign);
      std::memcpy(buffer.bytes().data(), &stored, sizeof(stored));
      const auto value = std::get<std::span<const float>>(buffer.Halves())[0];
      EXPECT_EQ(NearestHalf(value), stored);
    }
  }
  EXPECT_EQ(NearestHalf(1e9F), 0x7bff);
  EXPECT_EQ(NearestHalf(-HUGE_VALF), 0xfc00);
  EXPECT_EQ(NearestHalf(NAN), 0x7e00);
}

TEST(Zarr, RefusesMetadataThatIsNone) {
  EXPECT_THAT(ErrorOfArray({{"{", "["}, {"}", "]"}}), HasSubstr("not a JSON object"));
  EXPECT_THAT(ErrorOfArray({{"\"zarr_format\":2", "\"zarr_format\":4"}}),
              HasSubstr("zarr_format '4' is neither 2 nor 3"));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4]", "\"shape\":[2,3]"}}), HasSubstr("chunks have 3"));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4]", "\"shape\":[2,3,-4]"}}),
              HasSubstr("holds no voxels"));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4]", "\"shape\":[2,3,4.5]"}}),
              HasSubstr("shape '4.5' is not a whole number"));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4]", "\"shape\":[2,3,18446744073709551615]"}}),
              HasSubstr("not a whole number"));
  EXPECT_THAT(ErrorOfArray({{"\"chunks\":[2,3,4]", "\"chunks\":[2,0,4]"}}),
              HasSubstr("chunks are 0 long"));
  EXPECT_THAT(ErrorOfArray({{"|u1", "<f3"}}), HasSubstr("dtype '<f3'"));
  EXPECT_THAT(ErrorOfArray({{"|u1", "|u2"}}), HasSubstr("dtype '|u2'"));
  EXPECT_THAT(ErrorOfArray({{"|u1", ""}}), HasSubstr("dtype ''"));
  EXPECT_THAT(ErrorOfArray({{"\"fill_value\":0", "\"fill_value\":256"}}), HasSubstr("fill_value"));
  EXPECT_THAT(ErrorOfArray({{"\"order\":\"C\"", "\"order\":\"K\""}}), HasSubstr("neither C nor F"));
  EXPECT_THAT(ErrorOfArray({{"\"compressor\":null", "\"compressor\":{\"id\":\"lzma\"}"}}),
              HasSubstr("compressor 'lzma' is not supported"));
  EXPECT_THAT(ErrorOfArray({{"\"filters\":null", "\"filters\":[{\"id\":\"delta\"}]"}}),
              AllOf(HasSubstr("UNIMPLEMENTED"), HasSubstr("delta")));
}

TEST(Zarr, RefusesSizesThatAreBombs) {
  EXPECT_THAT(ErrorOfArray({{"\"chunks\":[2,3,4]", "\"chunks\":[65536,65536,65536]"}}),
              AllOf(HasSubstr("RESOURCE_EXHAUSTED"), HasSubstr("write smaller chunks")));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4]", "\"shape\":[9,9,9223372036854775807]"}}),
              HasSubstr("RESOURCE_EXHAUSTED"));
  EXPECT_THAT(ErrorOfArray({{"\"shape\":[2,3,4],\"chunks\":[2,3,4]",
                             "\"shape\":[1000,1000,1000],\"chunks\":[1,1,1]"}}),
              HasSubstr("cut the image into 1000000000, the limit is"));
}

TEST(Zarr, RefusesChunksOfAnotherLength) {
  const ImageFolder folder("chunks.zarr");
  folder.Write(".zarray", Array());
  folder.Write("0.0.0", Counting<uint8_t>(23));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("chunk '0.0.0': it expands to 23 bytes, a chunk has 24"));
  folder.Write("0.0.0", Counting<uint8_t>(25));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("more than the 24 bytes"));
  folder.Write("0.0.0", std::string(1 << 20, 'x'));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("too many for a chunk of 24"));
  folder.Write(".zarray", Array({{"\"compressor\":null", "\"compressor\":{\"id\":\"zlib\"}"}}));
  folder.Write("0.0.0", testing::Deflated(std::string(1 << 20, 'x'), testing::Wrapping::kZlib));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("more than the 24 bytes"));
}

TEST(Zarr, RefusesDamagedChunksOfEveryCodec) {
  for (const std::string codec : {"blosc", "zstd", "lz4", "gzip", "zlib"}) {
    const ImageFolder folder("damaged.zarr");
    folder.Write(".zarray",
                 Array({{"\"compressor\":null", "\"compressor\":{\"id\":\"" + codec + "\"}"}}));
    for (const std::string& bytes : {std::string(), std::string(3, 'x'), std::string(40, '\x18'),
                                     std::string("\x18\0\0\0\xf0", 5), std::string(40, '\xff')}) {
      folder.Write("0.0.0", bytes);
      EXPECT_THAT(ErrorOf(folder), HasSubstr("chunk '0.0.0': ")) << codec;
    }
  }
}

TEST(Zarr, RefusesGroupsThatAreNotRead) {
  const ImageFolder folder("group.ome.zarr");
  folder.Write("0/.zarray", Array());
  folder.Write(".zgroup", R"({"zarr_format":2})");
  EXPECT_THAT(ErrorOf(folder), HasSubstr("states no multiscales"));
  const auto error_of = [&](const std::string& attributes) {
    folder.Write(".zattrs", attributes);
    return ErrorOf(folder);
  };
  EXPECT_EQ(error_of(Multiscales(kAxes + "," + kDatasets)), "read");
  EXPECT_THAT(error_of(R"({"multiscales":[{"version":"0.7"}]})"),
              HasSubstr("version '0.7' is not supported; 0.1 to 0.5 are"));
  EXPECT_THAT(error_of(Multiscales(kAxes)), HasSubstr("datasets"));
  for (const char* path : {"../x", "/etc", "a/../../b", ""}) {
    EXPECT_THAT(error_of(Multiscales(kAxes + R"(,"datasets":[{"path":")" + path + R"("}])")),
                HasSubstr("is not that of an array in the folder"))
        << path;
  }
  EXPECT_THAT(error_of(Multiscales(R"("axes":["z","y","q"],)" + kDatasets)), HasSubstr("axis 'q'"));
  EXPECT_THAT(error_of(Multiscales(R"("axes":["y","x"],)" + kDatasets)),
              HasSubstr("the array has 3 axes, 2 are named"));
  const auto with_steps = [&](const std::string& steps) {
    return error_of(Multiscales(kAxes + R"(,"datasets":[{"path":"0","coordinateTransformations":)" +
                                steps + "}]"));
  };
  EXPECT_THAT(with_steps(R"([{"type":"scale","scale":[1,2]}])"), HasSubstr("2 numbers for 3 axes"));
  EXPECT_THAT(with_steps(R"([{"type":"scale","scale":[1,2,0]}])"), HasSubstr("positive"));
  EXPECT_THAT(with_steps(R"([{"type":"affine"}])"), HasSubstr("neither a scale nor"));
}

// "OME.zarr/0" is what programs name that show the levels.
TEST(Zarr, OfALevelLiesWhereTheGroupAbovePlacesIt) {
  const ImageFolder folder("above.ome.zarr");
  folder.Write(".zattrs", Multiscales(kAxes + R"(,"datasets":[{"path":"0"},{"path":"1",)"
                                              R"("coordinateTransformations":[{"type":"scale",)"
                                              R"("scale":[4,2,1]}]},{"path":"2","coordinate)"
                                              R"(Transformations":[{"type":"affine"}]}])"));
  for (const char* level : {"1", "2", "other"}) {
    folder.Write(std::string(level) + "/.zarray", Array());
    folder.Write(std::string(level) + "/0.0.0", Counting<uint8_t>(24));
  }
  for (const char* name : {"/1", "/1/", "/./1"}) {
    const auto image = MustRead(testing::ReadAll(OpenImage(folder.path() + name)));
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 4));
    EXPECT_EQ(image.info.unit, "um");
    EXPECT_EQ(image.values, CountedTo(24));
  }
  EXPECT_THAT(std::string(OpenImage(folder.path() + "/2").status().message()),
              HasSubstr("neither a scale nor"));
  const auto other = MustRead(testing::ReadAll(OpenImage(folder.path() + "/other")));
  EXPECT_EQ(other.info.unit, "");
}

// Whatever one changed or lost byte of the metadata makes of them: an error or an image, no crash.
TEST(Zarr, WithdrawsFromAnyDamageOfItsMetadata) {
  const ImageFolder folder("flipped.ome.zarr");
  folder.Write("0/0.0.0", Counting<uint8_t>(24));
  const std::string attributes = Multiscales(kAxes + "," + kDatasets);
  ImageOptions options;
  options.limits.max_voxels = 1 << 16;
  folder.Write("0/.zarray", Array());
  const int read = ReadsOfDamaged(folder, ".zattrs", attributes, options);
  EXPECT_GT(read + ReadsOfDamaged(folder, "0/.zarray", Array(), options), 0);
  EXPECT_TRUE(folder.Read(options).ok());
}

}  // namespace
}  // namespace bccskel
