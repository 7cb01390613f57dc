// Archives of arrays written by libzip, some damaged afterwards. Those of NumPy:
// foreign_images_test.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zip.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "tests/core/import/image/image_bytes.h"

namespace bccskel {
namespace {

using testing::CountedTo;
using testing::Counting;
using testing::ErrorOfBytes;
using ::testing::HasSubstr;
using testing::ReadBytes;

struct Member {
  std::string name, bytes;
  int method = ZIP_CM_STORE;
};

std::string Zip(const std::vector<Member>& members) {
  zip_source_t* bytes = zip_source_buffer_create(nullptr, 0, 0, nullptr);
  zip_source_keep(bytes);
  zip_t* zip = zip_open_from_source(bytes, ZIP_TRUNCATE, nullptr);
  for (const Member& member : members) {
    const zip_int64_t index =
        zip_file_add(zip, member.name.c_str(),
                     zip_source_buffer(zip, member.bytes.data(), member.bytes.size(), 0), 0);
    if (index < 0) std::abort();
    zip_set_file_compression(zip, static_cast<zip_uint64_t>(index), member.method, 0);
  }
  if (zip_close(zip) != 0 || zip_source_open(bytes) != 0) std::abort();
  zip_stat_t stat;
  zip_source_stat(bytes, &stat);
  std::string archive(stat.size, '\0');
  zip_source_read(bytes, archive.data(), archive.size());
  zip_source_close(bytes);
  zip_source_free(bytes);
  return archive;
}

// Of so many slices of 3 x 2 voxels whose values count.
std::string NpySlices(int slices, bool fortran = false) {
  const std::string shape = std::to_string(slices);
  const std::string dictionary =
      fortran ? "{'descr': '|u1', 'fortran_order': True, 'shape': (3, 2, " + shape + "), }"
              : "{'descr': '|u1', 'fortran_order': False, 'shape': (" + shape + ", 2, 3), }";
  return std::string("\x93NUMPY\x01\x00", 8) +
         testing::Bytes(static_cast<uint16_t>(dictionary.size())) + dictionary +
         Counting<uint8_t>(6 * static_cast<size_t>(slices));
}

ImageOptions ArrayNamed(const char* name) {
  ImageOptions options;
  options.array = name;
  return options;
}

TEST(Npz, GivesTheOnlyArrayWhetherStoredOrDeflated) {
  for (const int method : {ZIP_CM_STORE, ZIP_CM_DEFLATE}) {
    const std::string archive =
        Zip({{"notes.txt", "no array", method}, {"arr_0.npy", NpySlices(40), method}});
    const auto image = MustRead(ReadBytes(archive));
    EXPECT_EQ(image.info.format, "npy");
    EXPECT_EQ(image.info.size, (ImageSize{3, 2, 40}));
    EXPECT_EQ(image.values, CountedTo(240));
    EXPECT_TRUE(ReadBytes(testing::Deflated(archive, testing::Wrapping::kGzip)).ok());
  }
}

TEST(Npz, GivesTheSameInFortranOrderSlabBySlab) {
  ImageOptions options;
  options.limits.max_slab_bytes = 7;
  const auto whole = ReadBytes(NpySlices(5, true));
  const auto image =
      MustRead(ReadBytes(Zip({{"a.npy", NpySlices(5, true), ZIP_CM_DEFLATE}}), options));
  EXPECT_EQ(image.values, whole->values);
}

TEST(Npz, ChoosesAnArrayByItsName) {
  const std::string archive =
      Zip({{"raw.npy", NpySlices(1)}, {"mask.npy", NpySlices(2)}, {"t/x.npy", NpySlices(3)}});
  EXPECT_THAT(ErrorOfBytes(archive),
              HasSubstr("the file holds 3 arrays, 'raw', 'mask', 't/x'; choose "
                        "one with --array NAME"));
  EXPECT_THAT(ErrorOfBytes(archive, ArrayNamed("masks")),
              HasSubstr("--array 'masks' is not there; there are 'raw', 'mask', 't/x'"));
  const auto image = MustRead(ReadBytes(archive, ArrayNamed("mask")));
  EXPECT_EQ(image.values, CountedTo(12));
  EXPECT_THAT(ErrorOfBytes(NpySlices(1), ArrayNamed("mask")),
              HasSubstr("--array applies only to .npz files"));
}

TEST(Npz, RefusesWhatHoldsNoArray) {
  EXPECT_THAT(ErrorOfBytes(Zip({{"word/document.xml", "<x/>"}})), HasSubstr("holds no .npy array"));
  EXPECT_THAT(ErrorOfBytes(Zip({{"a.npy", "text"}})),
              HasSubstr("'a.npy' in it is not an npy file"));
  EXPECT_THAT(ErrorOfBytes(std::string("PK\5\6", 4) + std::string(18, '\0')),
              HasSubstr("holds no .npy array"));
}

TEST(Npz, RefusesEveryCutAndDamagedVoxels) {
  for (const int method : {ZIP_CM_STORE, ZIP_CM_DEFLATE}) {
    const std::string archive = Zip({{"a.npy", NpySlices(2), method}});
    for (size_t size = 0; size < archive.size(); ++size) {
      EXPECT_FALSE(ReadBytes(archive.substr(0, size)).ok()) << size;
    }
    std::string changed = archive;
    const size_t last = archive.find("PK\1\2") - 1;  // of the member's bytes
    changed[last] = static_cast<char>(changed[last] ^ 1);
    EXPECT_FALSE(ReadBytes(changed).ok());
    if (method == ZIP_CM_STORE) {
      EXPECT_THAT(ErrorOfBytes(changed), HasSubstr("the array is cut or damaged: CRC error"));
    }
  }
}

TEST(Npz, RefusesMoreAndFewerVoxelsThanDeclared) {
  std::string npy = NpySlices(2);
  EXPECT_THAT(ErrorOfBytes(Zip({{"a.npy", npy + "more"}})), HasSubstr("stream holds more"));
  npy.resize(npy.size() - 1);
  EXPECT_THAT(ErrorOfBytes(Zip({{"a.npy", npy}})),
              HasSubstr("the voxels end 1 bytes before slice 1 is complete"));
  const std::string huge = "{'descr': '|u1', 'fortran_order': False, 'shape': (9, 30000, 30000), }";
  EXPECT_THAT(ErrorOfBytes(Zip({{"a.npy",
                                 std::string("\x93NUMPY\x01\x00", 8) +
                                     testing::Bytes(static_cast<uint16_t>(huge.size())) + huge,
                                 ZIP_CM_DEFLATE}})),
              HasSubstr("the header declares 8100000000 bytes of voxels"));
}

}  // namespace
}  // namespace bccskel
