#include "core/labels/nrrd_writer.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <string>

#include "core/import/image/foreground.h"
#include "core/import/image/open_image.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

using testing::HasSubstr;

class WrittenNrrd : public ::testing::Test {
 protected:
  void Write(const MaskGrid& grid, const ImageWorld& world, const SparseImage& image) const {
    const absl::StatusOr<std::string> bytes = NrrdBytes(grid, world, image);
    ASSERT_TRUE(bytes.ok()) << bytes.status();
    folder_.Write("written.nrrd", *bytes);
  }
  const test::TemporaryFolder folder_;
  const std::string path_ = folder_ / "written.nrrd";
};

std::string Unzipped(const std::string& path, size_t offset, size_t bytes) {
  std::string packed = test::BytesOfFile(path).substr(offset);
  std::string plain(bytes + 1, '\0');
  z_stream stream = {};
  inflateInit2(&stream, 15 + 16);
  stream.next_in = reinterpret_cast<Bytef*>(packed.data());
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(plain.data());
  stream.avail_out = static_cast<uInt>(plain.size());
  EXPECT_EQ(inflate(&stream, Z_FINISH), Z_STREAM_END);
  plain.resize(stream.total_out);
  inflateEnd(&stream);
  return plain;
}

TEST_F(WrittenNrrd, HoldsHeaderAndVoxels) {
  const MaskGrid grid = {5, 3, 2, {{4, 2, 3}, {7, 8, 9}, {0, -1, 0, 1, 0, 0, 0, 0, 1}}};
  const SparseImage image = {{{0, 1, 1, 3}, 70000}, {{1, 2, 4, 5}, 2}};
  Write(grid, {}, image);
  const std::string text = test::BytesOfFile(path_);
  const size_t data = text.find("\n\n") + 2;
  EXPECT_THAT(text.substr(0, data), HasSubstr("sizes: 5 3 2\n"));
  EXPECT_THAT(text.substr(0, data), HasSubstr("space directions: (0,4,0) (-2,0,0) (0,0,3)\n"));
  EXPECT_THAT(text.substr(0, data), HasSubstr("space origin: (7,8,9)\n"));
  std::vector<uint32_t> expected(30);
  expected[6] = expected[7] = 70000;
  expected[29] = 2;
  const std::string plain = Unzipped(path_, data, 120);
  ASSERT_EQ(plain.size(), 120u);
  EXPECT_EQ(std::memcmp(plain.data(), expected.data(), 120), 0);
}

TEST_F(WrittenNrrd, IsReadBackAsItWas) {
  const MaskGrid grid = {5, 3, 2, {{4, 2, 3}, {7, 8, 9}, {0, -1, 0, 1, 0, 0, 0, 0, 1}}};
  Write(grid, {}, {{{1, 2, 3, 5}, 4000000000}});
  const auto image = OpenImage(path_);
  ASSERT_TRUE(image.ok()) << image.status();
  EXPECT_EQ((*image)->info().size, (ImageSize{5, 3, 2}));
  EXPECT_EQ((*image)->info().type, VoxelType::kUint32);
  EXPECT_EQ((*image)->info().placement, grid.placement);
  std::vector<uint64_t> labels(15);
  ASSERT_TRUE((*image)->NextSlice().ok());
  const auto slice = (*image)->NextSlice();
  ASSERT_TRUE(slice.ok()) << slice.status();
  ASSERT_TRUE(LabelSlice(*slice, labels).ok());
  std::vector<uint64_t> expected(15);
  expected[13] = expected[14] = 4000000000;
  EXPECT_EQ(labels, expected);
}

TEST_F(WrittenNrrd, NamesTheWorldSoThatViewersDoNotMirrorIt) {
  const MaskGrid grid = {1, 1, 1, {}};
  for (const std::string axes : {"RAS", "LPS", "LAS", ""}) {
    for (const std::string unit : {"mm", "um", ""}) {
      Write(grid, {axes, unit}, {});
      const auto image = OpenImage(path_);
      ASSERT_TRUE(image.ok()) << image.status();
      EXPECT_EQ((*image)->info().world, axes);
      EXPECT_EQ((*image)->info().unit, unit);
    }
  }
}

TEST_F(WrittenNrrd, IsNotMadeOfRunsOutsideOrOutOfOrder) {
  const MaskGrid grid = {5, 3, 2, {}};
  for (const SparseImage& image :
       {SparseImage{{{0, 0, 3, 6}, 1}}, SparseImage{{{2, 0, 0, 1}, 1}},
        SparseImage{{{0, 1, 0, 1}, 1}, {{0, 0, 0, 1}, 1}}, SparseImage{{{0, 0, 2, 2}, 1}}}) {
    EXPECT_EQ(NrrdBytes(grid, {}, image).status().code(), absl::StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace bccskel
