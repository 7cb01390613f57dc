// Neuroglancer precomputed volumes written by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "absl/strings/str_replace.h"
#include "tests/core/import/image/image_folder.h"

namespace bccskel {
namespace {

using ::testing::AllOf;
using testing::Bytes;
using ::testing::ElementsAre;
using testing::ErrorOf;
using ::testing::HasSubstr;
using testing::ImageFolder;

constexpr int kX = 5, kY = 3, kZ = 4;

uint64_t LabelAt(int x, int y, int z) {
  return x == 4 ? 7 : (uint64_t{1} << 40) + static_cast<uint64_t>((x + 2 * y + 3 * z) % 6);
}

std::vector<double> Labels() {
  std::vector<double> labels;
  for (int z = 0; z < kZ; ++z) {
    for (int y = 0; y < kY; ++y) {
      for (int x = 0; x < kX; ++x) labels.push_back(static_cast<double>(LabelAt(x, y, z)));
    }
  }
  return labels;
}

std::string Info(const std::string& encoding) {
  return R"({"@type":"neuroglancer_multiscale_volume","type":"segmentation","num_channels":1,)"
         R"("data_type":"uint64","scales":[{"key":"8_8_40","size":[5,3,4],"resolution":[8,8,40],)"
         R"("voxel_offset":[10,-20,30],"chunk_sizes":[[4,3,2]],"encoding":)" +
         encoding + "}]}";
}

const std::string kRaw = R"("raw")";
const std::string kCompressed =
    R"("compressed_segmentation","compressed_segmentation_block_size":[2,2,2])";

struct Box {
  int low[3], high[3];
};

std::string RawChunk(const Box& box) {
  std::string bytes;
  for (int z = box.low[2]; z < box.high[2]; ++z) {
    for (int y = box.low[1]; y < box.high[1]; ++y) {
      for (int x = box.low[0]; x < box.high[0]; ++x) bytes += Bytes(LabelAt(x, y, z));
    }
  }
  return bytes;
}

// Blocks of 2 x 2 x 2, as the specification says: two words for each, then tables and values.
std::string CompressedChunk(const Box& box) {
  std::vector<uint32_t> headers, words;
  const auto blocks = [&](int axis) { return (box.high[axis] - box.low[axis] + 1) / 2; };
  const auto first = static_cast<uint32_t>(2 * blocks(0) * blocks(1) * blocks(2));
  for (int block = 0; block < blocks(0) * blocks(1) * blocks(2); ++block) {
    const int bx = block % blocks(0), by = block / blocks(0) % blocks(1),
              bz = block / blocks(0) / blocks(1);
    std::map<uint64_t, uint32_t> table;
    std::vector<std::pair<uint32_t, uint64_t>> labels;  // place in the block, label
    for (int n = 0; n < 8; ++n) {
      const int x = box.low[0] + 2 * bx + n % 2, y = box.low[1] + 2 * by + n / 2 % 2,
                z = box.low[2] + 2 * bz + n / 4;
      if (x >= box.high[0] || y >= box.high[1] || z >= box.high[2]) continue;
      labels.emplace_back(n, LabelAt(x, y, z));
      table.emplace(LabelAt(x, y, z), 0);
    }
    uint32_t bits = 0;
    while ((size_t{1} << bits) < table.size()) bits = bits == 0 ? 1 : 2 * bits;
    const auto values = first + static_cast<uint32_t>(words.size());
    words.resize(words.size() + (8 * bits + 31) / 32);
    headers.push_back((first + static_cast<uint32_t>(words.size())) | bits << 24);
    headers.push_back(values);
    uint32_t index = 0;
    for (auto& [label, at] : table) {
      at = index++;
      words.push_back(static_cast<uint32_t>(label));
      words.push_back(static_cast<uint32_t>(label >> 32));
    }
    for (const auto& [place, label] : labels) {
      if (bits > 0)
        words[values - first + place * bits / 32] |= table[label] << (place * bits % 32);
    }
  }
  std::string bytes = Bytes<uint32_t>(1);
  for (const auto& part : {headers, words}) {
    for (const uint32_t word : part) bytes += Bytes(word);
  }
  return bytes;
}

void WriteChunks(const ImageFolder& folder, std::string (*chunk)(const Box& box)) {
  const auto gzip = testing::Wrapping::kGzip;
  folder.Write("8_8_40/10-14_-20--17_30-32", chunk({{0, 0, 0}, {4, 3, 2}}));
  folder.Write("8_8_40/14-15_-20--17_30-32",
               testing::Deflated(chunk({{4, 0, 0}, {5, 3, 2}}), gzip));
  folder.Write("8_8_40/10-14_-20--17_32-34.gz",
               testing::Deflated(chunk({{0, 0, 2}, {4, 3, 4}}), gzip));
  folder.Write("8_8_40/14-15_-20--17_32-34", chunk({{4, 0, 2}, {5, 3, 4}}));
}

TEST(Precomputed, IsReadRawAndCompressed) {
  for (const bool raw : {true, false}) {
    const ImageFolder folder("volume");
    folder.Write("info", Info(raw ? kRaw : kCompressed));
    WriteChunks(folder, raw ? &RawChunk : &CompressedChunk);
    const auto image = MustRead(folder.Read());
    EXPECT_EQ(image.info.format, "precomputed");
    EXPECT_EQ(image.info.size, (ImageSize{kX, kY, kZ}));
    EXPECT_EQ(image.info.type, VoxelType::kUint64);
    EXPECT_EQ(image.info.unit, "nm");
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(8, 8, 40));
    EXPECT_THAT(image.info.placement.origin, ElementsAre(84, -156, 1220));
    EXPECT_EQ(image.values, Labels());
  }
}

TEST(Precomputed, IsExpandedThoughTheStreamIsAsLongAsAChunk) {
  std::string voxels(100, '\0');
  std::string stream;
  for (size_t n = 0; n < voxels.size() && stream.size() != voxels.size(); ++n) {
    voxels[n] = static_cast<char>(n * n * n + 7 * n);
    stream = testing::Deflated(voxels, testing::Wrapping::kGzip);
  }
  ASSERT_EQ(stream.size(), voxels.size());
  const ImageFolder folder("as_long");
  folder.Write("info", R"({"type":"segmentation","data_type":"uint8","num_channels":1,"scales":[
      {"key":"s","size":[100,1,1],"resolution":[1,1,1],"chunk_sizes":[[100,1,1]],
       "encoding":"raw"}]})");
  folder.Write("s/0-100_0-1_0-1", stream);
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.values[0], 0);
  EXPECT_EQ(image.values[1], 8);
}

TEST(Precomputed, IsEmptyWhereChunksAreMissing) {
  const ImageFolder folder("gaps");
  folder.Write("info", Info(kRaw));
  const auto image = MustRead(folder.Read());
  EXPECT_EQ(image.values, std::vector<double>(kX * kY * kZ));
}

TEST(Precomputed, IsReadRawWhereVoxelsBeginAsGzipDoes) {
  const ImageFolder folder("magic");
  folder.Write("info",
               absl::StrReplaceAll(Info(kRaw), {{"uint64", "uint8"}, {"[5,3,4]", "[2,1,1]"}}));
  folder.Write("8_8_40/10-12_-20--19_30-31", "\x1f\x8b");
  const auto image = MustRead(folder.Read());
  EXPECT_THAT(image.values, ElementsAre(0x1f, 0x8b));
}

TEST(Precomputed, RefusesWhatIsNotRead) {
  const ImageFolder folder("refused");
  const auto error_of = [&](const std::string& from, const std::string& to) {
    EXPECT_NE(Info(kRaw).find(from), std::string::npos) << from;
    folder.Write("info", absl::StrReplaceAll(Info(kRaw), {{from, to}}));
    return ErrorOf(folder);
  };
  EXPECT_THAT(error_of("\"encoding\"", "\"sharding\":{\"@type\":\"x\"},\"encoding\""),
              AllOf(HasSubstr("UNIMPLEMENTED"), HasSubstr("is sharded")));
  EXPECT_THAT(error_of("\"raw\"", "\"jpeg\""), HasSubstr("encoding 'jpeg' is not supported"));
  EXPECT_THAT(error_of("\"num_channels\":1", "\"num_channels\":3"), HasSubstr("only one channel"));
  EXPECT_THAT(error_of("multiscale_volume", "skeletons"), HasSubstr("not that of a volume"));
  const std::string deep(400'000, '[');
  EXPECT_THAT(error_of("\"neuroglancer_multiscale_volume\"", deep + std::string(deep.size(), ']')),
              HasSubstr("has values nested more than 64 deep"));
  EXPECT_THAT(error_of("uint64", "uint63"), HasSubstr("'uint63' is not a voxel type"));
  EXPECT_THAT(error_of("8_8_40", "../x"), HasSubstr("not that of a folder in this one"));
  EXPECT_THAT(error_of("[5,3,4]", "[5,3]"), HasSubstr("size has 2 numbers"));
  EXPECT_THAT(error_of("[5,3,4]", "[5,3,9223372036854775807]"), HasSubstr("RESOURCE_EXHAUSTED"));
  EXPECT_THAT(error_of("[8,8,40]", "[8,8,0]"), HasSubstr("positive"));
  EXPECT_THAT(error_of("[10,-20,30]", "[9223372036854775807,0,0]"), HasSubstr("too far from 0"));
  EXPECT_THAT(error_of("[4,3,2]", "[4,3,0]"), HasSubstr("chunk_sizes is 0 along one axis"));
  EXPECT_THAT(error_of("[4,3,2]", "[65536,65536,65536]"), HasSubstr("over the limit"));
  folder.Write("info", absl::StrReplaceAll(Info(kCompressed), {{"uint64", "uint16"}}));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("has no compressed segmentation"));
  folder.Write("info", Info(kRaw));
  ImageOptions options;
  options.level = 1;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("level 1 is not there: the image has 1"));
  options = {};
  options.channel = 0;
  EXPECT_THAT(ErrorOf(folder, options), HasSubstr("apply only to TIFF and OME-Zarr"));
}

// Every cut and every changed byte of a chunk gives an error or other labels, no crash.
TEST(Precomputed, WithdrawsFromDamagedChunks) {
  const ImageFolder folder("damaged");
  folder.Write("info", Info(kCompressed));
  WriteChunks(folder, &CompressedChunk);
  const std::string name = "8_8_40/10-14_-20--17_30-32";
  const std::string good = CompressedChunk({{0, 0, 0}, {4, 3, 2}});
  for (size_t at = 0; at < good.size(); ++at) {
    std::string changed = good;
    changed[at] = '\xff';
    folder.Write(name, changed);
    const auto image = folder.Read();
    EXPECT_TRUE(!image.ok() || image->values.size() == Labels().size()) << at;
    folder.Write(name, good.substr(0, at));
    EXPECT_THAT(ErrorOf(folder), HasSubstr("chunk '10-14_-20--17_30-32': ")) << at;
  }
  folder.Write(name, std::string(1 << 20, '\1'));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("too many for a chunk"));
  folder.Write("info", Info(kRaw));
  folder.Write(name, std::string(23, 'x'));
  EXPECT_THAT(ErrorOf(folder), HasSubstr("it expands to 23 bytes, a chunk has 192"));
}

TEST(Precomputed, WithdrawsFromAnyDamageOfItsInfo) {
  const ImageFolder folder("flipped");
  const std::string info = Info(kCompressed);
  ImageOptions options;
  options.limits.max_voxels = 1 << 16;
  for (size_t at = 0; at < info.size(); ++at) {
    std::string changed = info;
    changed[at] = '9';
    folder.Write("info", changed);
    folder.Read(options).status().IgnoreError();
    folder.Write("info", info.substr(0, at));
    EXPECT_FALSE(folder.Read(options).ok()) << at;
  }
}

}  // namespace
}  // namespace bccskel
