// Zarr 3 and OME-Zarr 0.5, written by hand: what is read, and what is refused.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "absl/strings/str_replace.h"
#include "tests/core/import/image/image_folder.h"

namespace bccskel {
namespace {

using ::testing::AllOf;
using testing::Bytes;
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
const std::string kArray3 =
    R"({"zarr_format":3,"node_type":"array","shape":[2,3,4],"data_type":"uint8",)"
    R"("chunk_grid":{"name":"regular","configuration":{"chunk_shape":[2,3,4]}},)"
    R"("chunk_key_encoding":{"name":"default","configuration":{"separator":"/"}},)"
    R"("fill_value":0,"codecs":[{"name":"bytes"}],"attributes":{},"dimension_names":null})";

std::string Array3(const Replacements& changes = {}) { return Replaced(kArray3, changes); }

Replacements Codecs(const std::string& codecs) {
  return {{R"([{"name":"bytes"}])", "[" + codecs + "]"}};
}

std::string ErrorOfArray3(const Replacements& changes) {
  const ImageFolder folder("array3.zarr");
  folder.Write("zarr.json", Array3(changes));
  folder.Write("c/0/0/0", Counting<uint8_t>(24));
  return ErrorOf(folder);
}

void ExpectCounted(const ImageFolder& folder) {
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.size, (ImageSize{4, 3, 2}));
  EXPECT_EQ(image.values, CountedTo(24));
}

// CRC-32C bit by bit.
std::string Checksum(const std::string& bytes) {
  uint32_t sum = ~uint32_t{0};
  for (const char byte : bytes) {
    sum ^= static_cast<uint8_t>(byte);
    for (int bit = 0; bit < 8; ++bit) sum = sum >> 1 ^ (sum & 1 ? 0x82f63b78U : 0);
  }
  return Bytes(~sum);
}

TEST(Zarr3, IsReadWithEveryNameOfItsChunks) {
  const std::string encoding =
      R"("chunk_key_encoding":{"name":"default","configuration":{"separator":"/"}})";
  const std::vector<std::pair<std::string, std::string>> names = {
      {R"({"name":"default","configuration":{"separator":"/"}})", "c/0/0/0"},
      {R"({"name":"default","configuration":{"separator":"."}})", "c.0.0.0"},
      {R"({"name":"default"})", "c/0/0/0"},
      {R"("default")", "c/0/0/0"},
      {R"({"name":"v2"})", "0.0.0"},
      {R"({"name":"v2","configuration":{"separator":"/"}})", "0/0/0"}};
  for (const auto& [keys, name] : names) {
    const ImageFolder folder("names3.zarr");
    folder.Write("zarr.json", Array3({{encoding, R"("chunk_key_encoding":)" + keys}}));
    folder.Write(name, Counting<uint8_t>(24));
    ExpectCounted(folder);
  }
}

TEST(Zarr3, IsReadInEveryByteOrderAndOrderOfAxes) {
  const ImageFolder folder("orders3.zarr");
  folder.Write(
      "zarr.json",
      Array3({{"uint8", "int16"},
              {R"({"name":"bytes"})", R"({"name":"bytes","configuration":{"endian":"big"}})"}}));
  folder.Write("c/0/0/0", Counting<int16_t>(24, std::endian::big));
  ExpectCounted(folder);
  // Stored as [y][x][z]: the last one varies fastest.
  folder.Write("zarr.json",
               Array3(Codecs(R"({"name":"transpose","configuration":{"order":[1,2,0]}},"bytes")")));
  std::string turned;
  for (int y = 0; y < 3; ++y) {
    for (int x = 0; x < 4; ++x) {
      for (int z = 0; z < 2; ++z) turned += static_cast<char>(x + 4 * y + 12 * z);
    }
  }
  folder.Write("c/0/0/0", turned);
  ExpectCounted(folder);
}

TEST(Zarr3, ReadsTheAxesThatItNames) {
  const ImageFolder folder("axes3.zarr");
  folder.Write("zarr.json",
               Array3({{R"("dimension_names":null)", R"("dimension_names":["x","y","z"])"}}));
  folder.Write("c/0/0/0", Counting<uint8_t>(24));
  auto image = MustRead(folder.Read());
  EXPECT_EQ(image.info.size, (ImageSize{2, 3, 4}));
  EXPECT_EQ(image.values[1], 12);
  folder.Write("zarr.json",
               Array3({{R"("dimension_names":null)", R"("dimension_names":["depth",null,"x"])"}}));
  ExpectCounted(folder);
}

TEST(Zarr3, ExpandsChunksAndVerifiesTheirChecksums) {
  const ImageFolder folder("codecs3.zarr");
  const std::string voxels = Counting<uint8_t>(24);
  const std::string packed = testing::Deflated(voxels, testing::Wrapping::kGzip);
  folder.Write("zarr.json", Array3(Codecs(R"("bytes",{"name":"gzip"},"crc32c")")));
  folder.Write("c/0/0/0", packed + Checksum(packed));
  ExpectCounted(folder);
  std::string damaged = packed;
  damaged[12] = static_cast<char>(damaged[12] ^ 1);
  folder.Write("c/0/0/0", damaged + Checksum(packed));
  EXPECT_THAT(ErrorOf(folder), AllOf(HasSubstr("chunk 'c/0/0/0'"), HasSubstr("checksum")));
  folder.Write("c/0/0/0", "abc");
  EXPECT_THAT(ErrorOf(folder), HasSubstr("chunk 'c/0/0/0'"));
  folder.Write("zarr.json", Array3(Codecs(R"("bytes","numcodecs.zlib")")));
  folder.Write("c/0/0/0", testing::Deflated(voxels, testing::Wrapping::kZlib));
  ExpectCounted(folder);
  for (const std::string codec : {"blosc", "zstd", "gzip"}) {
    folder.Write("zarr.json", Array3(Codecs(R"("bytes",")" + codec + R"(")")));
    folder.Write("c/0/0/0", std::string(40, '\x18'));
    EXPECT_THAT(ErrorOf(folder), HasSubstr("chunk 'c/0/0/0': ")) << codec;
  }
}

TEST(Zarr3, HasTheFillValueWhereChunksAreMissing) {
  const auto fill_of = [](const std::string& type, const std::string& fill) {
    const ImageFolder folder("fill3.zarr");
    folder.Write("zarr.json",
                 Array3({{"uint8", type}, {R"("fill_value":0)", R"("fill_value":)" + fill}}));
    const auto image = folder.Read();
    EXPECT_TRUE(image.ok()) << image.status();
    return image.ok() ? image->values.back() : -1;
  };
  EXPECT_EQ(fill_of("bool", "true"), 1);
  EXPECT_EQ(fill_of("int64", "-9"), -9);
  EXPECT_EQ(fill_of("float32", R"("0x3fc00000")"), 1.5);
  EXPECT_EQ(fill_of("float16", R"("0xc000")"), -2);
  EXPECT_TRUE(std::isnan(fill_of("float64", R"("NaN")")));
  EXPECT_EQ(fill_of("float64", R"("-Infinity")"), -std::numeric_limits<double>::infinity());
  EXPECT_THAT(ErrorOfArray3({{"\"fill_value\":0", R"("fill_value":"0x00")"}}),
              HasSubstr("fill_value"));
}

// Four chunks of 1 x 3 x 2 voxels in a shard; the third one is missing.
struct Shard {
  std::string chunks[4];
  std::string index;

  explicit Shard(uint64_t first) {
    uint64_t at = first;
    for (int n = 0; n < 4; ++n) {
      for (int y = 0; n != 2 && y < 3; ++y) {
        for (int x = 0; x < 2; ++x) {
          chunks[n] += static_cast<char>(n / 2 * 12 + y * 4 + n % 2 * 2 + x);
        }
      }
      const bool missing = chunks[n].empty();
      index += Bytes(missing ? ~uint64_t{0} : at) + Bytes(missing ? ~uint64_t{0} : uint64_t{6});
      at += chunks[n].size();
    }
  }
  std::string Chunks() const { return chunks[0] + chunks[1] + chunks[2] + chunks[3]; }
};

std::string Sharding(const std::string& more, const std::string& codecs = R"("bytes")") {
  return R"({"name":"sharding_indexed","configuration":{"chunk_shape":[1,3,2],"codecs":[)" +
         codecs + R"(],)" + more + "}}";
}
const std::string kIndexed = R"("index_codecs":[{"name":"bytes"},{"name":"crc32c"}])";

std::vector<double> CountedWithoutThird() {
  std::vector<double> values = CountedTo(24);
  for (const size_t row : {size_t{12}, size_t{16}, size_t{20}}) values[row] = values[row + 1] = 0;
  return values;
}

TEST(Zarr3, ReadsShards) {
  const ImageFolder folder("shards.zarr");
  const auto expect_read = [&](const std::string& sharding, const std::string& bytes) {
    folder.Write("zarr.json", Array3(Codecs(sharding)));
    folder.Write("c/0/0/0", bytes);
    const auto image = MustRead(folder.Read());
    EXPECT_EQ(image.values, CountedWithoutThird());
  };
  const Shard behind(0);
  expect_read(Sharding(kIndexed), behind.Chunks() + behind.index + Checksum(behind.index));
  expect_read(Sharding(R"("index_location":"end","index_codecs":["bytes"])"),
              behind.Chunks() + behind.index);
  const Shard before(4 * 16 + 4);
  expect_read(Sharding(R"("index_location":"start",)" + kIndexed),
              before.index + Checksum(before.index) + before.Chunks());
}

TEST(Zarr3, ReadsSeveralShards) {
  const ImageFolder folder("more_shards.zarr");
  folder.Write("zarr.json", Array3({{"\"shape\":[2,3,4]", "\"shape\":[2,3,11]"},
                                    {R"([{"name":"bytes"}])", "[" + Sharding(kIndexed) + "]"}}));
  const Shard shard(0);
  const std::string bytes = shard.Chunks() + shard.index + Checksum(shard.index);
  folder.Write("c/0/0/0", bytes);
  folder.Write("c/0/0/2", bytes);
  const auto image = MustRead(folder.Read());
  const std::vector<double> once = CountedWithoutThird();
  ASSERT_EQ(image.values.size(), 66);
  for (size_t n = 0; n < 66; ++n) {
    const size_t x = n % 11, row = n / 11;
    EXPECT_EQ(image.values[n], x / 4 == 1 ? 0 : once[4 * row + x % 4]) << n;
  }
}

TEST(Zarr3, RefusesDamagedShards) {
  const ImageFolder folder("damaged_shards.zarr");
  const auto error_of = [&](const std::string& sharding, const std::string& bytes) {
    folder.Write("zarr.json", Array3(Codecs(sharding)));
    folder.Write("c/0/0/0", bytes);
    return ErrorOf(folder);
  };
  const Shard shard(0);
  EXPECT_THAT(error_of(Sharding(kIndexed), shard.Chunks() + shard.index + "1234"),
              AllOf(HasSubstr("chunk 'c/0/0/0'"), HasSubstr("checksum")));
  EXPECT_THAT(error_of(Sharding(kIndexed), "short"), HasSubstr("its index alone takes 68"));
  const Shard elsewhere(1000);
  EXPECT_THAT(error_of(Sharding(R"("index_codecs":["bytes"])"), elsewhere.index),
              HasSubstr("6 bytes from byte 1000 on cannot be a part of the file's 64"));
  const Shard inside_index(40);
  EXPECT_EQ(error_of(Sharding(R"("index_codecs":["bytes"])"), inside_index.index), "read");
  EXPECT_THAT(error_of(Sharding(kIndexed, R"("bytes","zstd")"),
                       shard.Chunks() + shard.index + Checksum(shard.index)),
              HasSubstr("zstd stream is damaged"));
}

TEST(Zarr3, RefusesMetadataThatIsNotRead) {
  const auto codecs_error = [](const std::string& codecs) { return ErrorOfArray3(Codecs(codecs)); };
  EXPECT_EQ(ErrorOfArray3({}), "read");
  EXPECT_THAT(ErrorOfArray3({{"\"array\"", "\"tree\""}}), HasSubstr("node_type 'tree'"));
  EXPECT_THAT(ErrorOfArray3({{"uint8", "complex64"}}), HasSubstr("data_type 'complex64'"));
  EXPECT_THAT(ErrorOfArray3({{"\"regular\"", "\"rectilinear\""}}), HasSubstr("is not regular"));
  EXPECT_THAT(ErrorOfArray3({{"\"chunk_shape\":[2,3,4]", "\"chunk_shape\":[2,3,0]"}}),
              HasSubstr("chunks are 0 long"));
  EXPECT_THAT(ErrorOfArray3({{"\"chunk_shape\":[2,3,4]", "\"chunk_shape\":[2,3]"}}),
              HasSubstr("its chunks have 2"));
  EXPECT_THAT(ErrorOfArray3({{"\"separator\":\"/\"", "\"separator\":\"-\""}}),
              HasSubstr("neither . nor /"));
  EXPECT_THAT(ErrorOfArray3({{"\"attributes\"", "\"future\""}}),
              AllOf(HasSubstr("UNIMPLEMENTED"), HasSubstr("future")));
  EXPECT_EQ(ErrorOfArray3({{"\"attributes\":{}", R"("future":{"must_understand":false})"}}),
            "read");
  EXPECT_THAT(codecs_error(""), HasSubstr("neither bytes nor sharding_indexed"));
  EXPECT_THAT(codecs_error(R"("zstd","bytes")"), HasSubstr("not in the order"));
  EXPECT_THAT(codecs_error(R"("bytes","bytes")"), HasSubstr("not in the order"));
  EXPECT_THAT(codecs_error(R"("bytes","zstd","gzip")"), HasSubstr("compress twice"));
  EXPECT_THAT(codecs_error(R"("bytes","crc32c","gzip")"), HasSubstr("one behind crc32c"));
  EXPECT_THAT(codecs_error(R"("bytes","packbits")"), HasSubstr("'packbits' is not supported"));
  EXPECT_THAT(codecs_error(R"({"name":"transpose","configuration":{"order":[0,0,1]}},"bytes")"),
              HasSubstr("not one order of the axes"));
  EXPECT_THAT(codecs_error(R"({"name":"bytes","configuration":{"endian":"middle"}})"),
              HasSubstr("neither little nor big"));
  EXPECT_THAT(codecs_error(Sharding(R"("index_codecs":["bytes","gzip"])")),
              HasSubstr("index_codecs"));
  EXPECT_THAT(codecs_error(Sharding(R"("index_codecs":"bytes")")), HasSubstr("is not a list"));
  EXPECT_THAT(codecs_error(Sharding(R"("index_location":"middle",)" + kIndexed)),
              HasSubstr("neither start nor end"));
  EXPECT_THAT(codecs_error(Sharding(kIndexed) + R"(,"gzip")"), HasSubstr("sharding_indexed"));
  EXPECT_THAT(codecs_error(Sharding(kIndexed, Sharding(kIndexed))), HasSubstr("sharding_indexed"));
  EXPECT_THAT(codecs_error(absl::StrReplaceAll(Sharding(kIndexed), {{"[1,3,2]", "[1,2,2]"}})),
              HasSubstr("no multiple of their chunks' 2"));
  EXPECT_THAT(ErrorOfArray3({{"[2,3,4]}", "[1073741824,1073741824,1073741824]}"},
                             {R"([{"name":"bytes"}])", "[" + Sharding(kIndexed) + "]"}}),
              HasSubstr("chunks"));
}

std::string Group(const std::string& version = "0.5") {
  return R"({"zarr_format":3,"node_type":"group","attributes":{"ome":{"version":")" + version +
         R"(","multiscales":[{"axes":[{"name":"z","type":"space","unit":"micrometer"},)"
         R"({"name":"y","type":"space","unit":"micrometer"},)"
         R"({"name":"x","type":"space","unit":"micrometer"}],"datasets":[{"path":"0",)"
         R"("coordinateTransformations":[{"type":"scale","scale":[4,2,1]}]},{"path":"1",)"
         R"("coordinateTransformations":[{"type":"scale","scale":[8,4,2]},)"
         R"({"type":"translation","translation":[3,5,7]}]}]}]}}})";
}

TEST(OmeZarr05, IsReadByLevel) {
  const ImageFolder folder("five.ome.zarr");
  folder.Write("zarr.json", Group());
  for (const char* level : {"0", "1"}) {
    folder.Write(std::string(level) + "/zarr.json", Array3());
    folder.Write(std::string(level) + "/c/0/0/0", Counting<uint8_t>(24));
  }
  ImageOptions options;
  options.level = 1;
  for (const auto& image :
       {folder.Read(options), testing::ReadAll(OpenImage(folder.path() + "/1"))}) {
    ASSERT_TRUE(image.ok()) << image.status();
    EXPECT_EQ(image->info.format, "OME-Zarr");
    EXPECT_EQ(image->info.unit, "um");
    EXPECT_THAT(image->info.placement.spacing, ElementsAre(2, 4, 8));
    EXPECT_THAT(image->info.placement.origin, ElementsAre(7, 5, 3));
    EXPECT_EQ(image->values, CountedTo(24));
  }
  folder.Write("zarr.json", Group("0.9"));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("version '0.9' is not supported; 0.1 to 0.5 are"));
  folder.Write("zarr.json", R"({"zarr_format":3,"node_type":"group"})");
  EXPECT_THAT(ErrorOf(folder), HasSubstr("states no multiscales"));
}

// As programs leave it that convert a folder in place.
TEST(OmeZarr05, CountsMoreThanOlderMetadataBesideIt) {
  const ImageFolder folder("both.zarr");
  folder.Write(".zarray", R"({"zarr_format":2})");
  folder.Write("zarr.json", Array3());
  folder.Write("c/0/0/0", Counting<uint8_t>(24));
  ExpectCounted(folder);
}

// Whatever one changed or lost byte of the metadata makes of them: an error or an image, no crash.
TEST(Zarr3, WithdrawsFromAnyDamage) {
  const ImageFolder folder("flipped3.zarr");
  ImageOptions options;
  options.limits.max_voxels = 1 << 16;
  const Shard shard(0);
  const std::string metadata = Array3(Codecs(Sharding(kIndexed)));
  const std::string bytes = shard.Chunks() + shard.index + Checksum(shard.index);
  folder.Write("zarr.json", metadata);
  // Changed voxels are read, a changed index is not; that of the missing chunk has 16 bytes 0xff.
  EXPECT_EQ(ReadsOfDamaged(folder, "c/0/0/0", bytes, options), 2 * 18 + 16);
  EXPECT_GT(ReadsOfDamaged(folder, "zarr.json", metadata, options), 0);
  EXPECT_TRUE(folder.Read(options).ok());
}

}  // namespace
}  // namespace bccskel
