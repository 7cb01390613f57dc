// Files that are cut, and files that hold more than they say.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/core/import/image/image_bytes.h"

namespace bccskel {
namespace {

using testing::Counting;
using testing::Deflated;
using ::testing::HasSubstr;
using testing::ReadBytes;
using testing::Wrapping;

struct Sample {
  const char* name;
  std::string bytes;
};
void PrintTo(const Sample& sample, std::ostream* out) { *out << sample.name; }

std::string Nrrd(const char* encoding) {
  return std::string("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: ") + encoding +
         "\n\n";
}
const std::string kMeta =
    "ObjectType = Image\nNDims = 3\nCompressedData = True\nDimSize = 3 2 2\n"
    "ElementType = MET_UCHAR\nElementDataFile = LOCAL\n";
const std::string kInr =
    "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nTYPE=unsigned fixed\nPIXSIZE=8 bits\n##}\n";
const std::string kVol = "X: 3\nY: 2\nZ: 2\nVoxel-Size: 1\nVersion: 2\n.\n";
const std::string kNpy = std::string("\x93NUMPY\x01\x00\x3e\x00", 10) +
                         "{'descr': '|u1', 'fortran_order': True, 'shape': (2, 2, 3), } ";

class CutImage : public ::testing::TestWithParam<Sample> {};

TEST_P(CutImage, IsRefusedWhereverItIsCut) {
  const std::string& bytes = GetParam().bytes;
  ASSERT_TRUE(ReadBytes(bytes).ok()) << ReadBytes(bytes).status();
  for (size_t size = 0; size < bytes.size(); ++size) {
    const auto image = ReadBytes(bytes.substr(0, size));
    EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument)
        << size << " of " << bytes.size() << ": " << image.status();
  }
}

const std::string kVoxels = Counting<uint8_t>(12);
INSTANTIATE_TEST_SUITE_P(
    All, CutImage,
    ::testing::Values(Sample{"nifti", testing::Nifti1Header() + kVoxels},
                      Sample{"nifti_gz",
                             Deflated(testing::Nifti1Header() + kVoxels, Wrapping::kGzip)},
                      Sample{"nrrd", Nrrd("raw") + kVoxels},
                      Sample{"nrrd_gzip", Nrrd("gzip") + Deflated(kVoxels, Wrapping::kGzip)},
                      Sample{"meta", kMeta + Deflated(kVoxels, Wrapping::kZlib)},
                      Sample{"inr", kInr + kVoxels}, Sample{"vol", kVol + kVoxels},
                      Sample{"npy", kNpy + kVoxels}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(CompressedImage, IsReadFromAFileThatIsCompressedAgain) {
  for (const std::string& bytes : {Nrrd("gzip") + Deflated(kVoxels, Wrapping::kGzip),
                                   kMeta + Deflated(kVoxels, Wrapping::kZlib)}) {
    const auto once = ReadBytes(bytes);
    const auto twice = MustRead(ReadBytes(Deflated(bytes, Wrapping::kGzip)));
    EXPECT_EQ(twice.values, once->values);
  }
}

TEST(CompressedImage, IsRefusedWhenItHoldsMoreThanDeclared) {
  const std::string bomb = Deflated(std::string(1 << 24, '\0'), Wrapping::kGzip);
  const auto image = ReadBytes(Nrrd("gzip") + bomb);
  EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("holds more"));
}

TEST(CompressedImage, IsRefusedWhenNoStreamOfItsLengthCanHoldWhatItDeclares) {
  const auto image =
      ReadBytes("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 1000 1000 1000\nencoding: gzip\n\n" +
                Deflated(kVoxels, Wrapping::kGzip));
  EXPECT_THAT(std::string(image.status().message()), HasSubstr("expand to at most"));
}

TEST(CompressedImage, IsRefusedWhenAWrongBitChangesIt) {
  const std::string front = Nrrd("gzip");
  const std::string bytes = front + Deflated(kVoxels, Wrapping::kGzip);
  // Behind gzip's own header, which has bytes that nobody checks.
  for (size_t at = front.size() + 10; at < bytes.size(); ++at) {
    std::string damaged = bytes;
    damaged[at] = static_cast<char>(damaged[at] ^ 4);
    const auto image = ReadBytes(damaged);
    if (image.ok()) {
      EXPECT_EQ(image->values, testing::CountedTo(12)) << "a bit that nobody reads: " << at;
    }
  }
}

TEST(PlainImage, MayBeFollowedByOtherBytesUnlessItIsRaw) {
  EXPECT_TRUE(ReadBytes(Nrrd("raw") + kVoxels + "\n").ok());
  ImageOptions options;
  options.raw = {.size = {3, 2, 2}};
  EXPECT_TRUE(ReadBytes(kVoxels, options).ok());
  EXPECT_FALSE(ReadBytes(kVoxels + "\n", options).ok());
}

}  // namespace
}  // namespace bccskel
