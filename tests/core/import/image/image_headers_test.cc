// What the headers of all formats refuse, and what they say about it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "absl/strings/str_cat.h"
#include "tests/core/import/image/image_bytes.h"

namespace bccskel::image_headers {
namespace {

using testing::Bytes;
using testing::Counting;
using ::testing::HasSubstr;
using testing::ReadBytes;

struct Refused {
  const char* name;
  std::string header;
  absl::StatusCode code;
  const char* message;
};
void PrintTo(const Refused& refused, std::ostream* out) { *out << refused.name; }

std::string Nrrd(const std::string& fields) {
  return absl::StrCat("NRRD0004\ntype: uint8\ndimension: 3\n", fields, "\n\n");
}
std::string Meta(const std::string& fields) {
  return absl::StrCat("ObjectType = Image\nNDims = 3\n", fields, "\nElementDataFile = LOCAL\n");
}
std::string Inr(const std::string& fields) {
  return absl::StrCat("#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\n", fields, "\n##}\n");
}
std::string Nifti(size_t at, const std::string& bytes) {
  return testing::Nifti1Header().replace(at, bytes.size(), bytes);
}
std::string Npy(const std::string& dictionary) {
  return std::string("\x93NUMPY\x01\x00", 8) + Bytes(static_cast<uint16_t>(dictionary.size())) +
         dictionary;
}

constexpr auto kInvalid = absl::StatusCode::kInvalidArgument;
constexpr auto kExhausted = absl::StatusCode::kResourceExhausted;
constexpr auto kUnimplemented = absl::StatusCode::kUnimplemented;

class RefusedHeader : public ::testing::TestWithParam<Refused> {};

TEST_P(RefusedHeader, IsNamedWithItsValue) {
  const auto image = ReadBytes(GetParam().header + Counting<uint8_t>(12));
  EXPECT_EQ(image.status().code(), GetParam().code) << image.status();
  EXPECT_THAT(std::string(image.status().message()), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    Nrrd, RefusedHeader,
    ::testing::Values(
        Refused{"sizes", Nrrd("sizes: 3 2\nencoding: raw"), kInvalid, "dimension '3'"},
        Refused{"words", Nrrd("sizes: 3 2 x\nencoding: raw"), kInvalid, "sizes 'x'"},
        Refused{"type", "NRRD0004\ntype: block\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n\n",
                kInvalid, "type 'block'"},
        Refused{"endian", "NRRD0004\ntype: short\ndimension: 3\nsizes: 3 2 1\nencoding: raw\n\n",
                kInvalid, "lacks 'endian'"},
        Refused{"encoding", Nrrd("sizes: 3 2 2\nencoding: bzip2"), kUnimplemented, "bzip2"},
        Refused{"axis", Nrrd("sizes: 3000000 1 1\nencoding: raw"), kExhausted, "3000000"},
        Refused{"twice", Nrrd("sizes: 3 2 2\nsizes: 3 2 2\nencoding: raw"), kInvalid, "twice"},
        Refused{"sheared",
                Nrrd("sizes: 3 2 2\nencoding: raw\nspace directions: (1,0,0) (0.5,1,0) (0,0,1)"),
                kInvalid, "not perpendicular"},
        Refused{"flat",
                Nrrd("sizes: 3 2 2\nencoding: raw\nspace directions: (1,0,0) (0,0,0) (0,0,1)"),
                kInvalid, "positive"},
        Refused{"vector", Nrrd("sizes: 3 2 2\nencoding: raw\nspace origin: (1,2"), kInvalid,
                "is not a vector"},
        Refused{"spacing", Nrrd("sizes: 3 2 2\nencoding: raw\nspacings: 1 inf 1"), kInvalid,
                "inf"}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    MetaImage, RefusedHeader,
    ::testing::Values(
        Refused{"channels",
                Meta("DimSize = 3 2 2\nElementType = MET_UCHAR\nElementNumberOfChannels = 3"),
                kInvalid, "ElementNumberOfChannels '3'"},
        Refused{"type", Meta("DimSize = 3 2 2\nElementType = MET_STRING"), kInvalid, "MET_STRING"},
        Refused{"text", Meta("DimSize = 3 2 2\nElementType = MET_UCHAR\nBinaryData = False"),
                kUnimplemented, "text"},
        Refused{"offset", Meta("DimSize = 3 2 2\nElementType = MET_UCHAR\nOffset = 1 2"), kInvalid,
                "Offset has 2 numbers"},
        Refused{"no_end", "ObjectType = Image\nNDims = 3\nDimSize = 3 2 2\nX = ", kInvalid,
                "header"}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Inrimage, RefusedHeader,
    ::testing::Values(
        Refused{"components", Inr("VDIM=2\nTYPE=unsigned fixed\nPIXSIZE=8 bits"), kInvalid, "VDIM"},
        Refused{"type", Inr("TYPE=packed\nPIXSIZE=1 bits"), kInvalid, "packed 1 bits"},
        Refused{"scale", Inr("TYPE=unsigned fixed\nPIXSIZE=8 bits\nSCALE=2**8"), kUnimplemented,
                "2**8"},
        Refused{"cpu", Inr("TYPE=float\nPIXSIZE=32 bits\nCPU=vax"), kInvalid, "vax"},
        Refused{"no_end", "#INRIMAGE-4#{\nXDIM=3\n", kInvalid, "header"}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Nifti, RefusedHeader,
    ::testing::Values(
        Refused{"axes", Nifti(40, Bytes<int16_t>(8)), kInvalid, "dim[0] is 8"},
        Refused{"negative", Nifti(42, Bytes<int16_t>(-3)), kInvalid, "-3"},
        Refused{"time", Nifti(40, Bytes<int16_t>(4)).replace(48, 2, Bytes<int16_t>(5)), kInvalid,
                "4 axes"},
        Refused{"rgb", Nifti(70, Bytes<int16_t>(128)), kInvalid, "datatype 128"},
        Refused{"offset", Nifti(108, Bytes(std::numeric_limits<float>::quiet_NaN())), kInvalid,
                "vox_offset is nan"},
        Refused{"far", Nifti(108, Bytes(1e14F)), kInvalid, "from byte 100000000376832"},
        Refused{"inside", Nifti(108, Bytes(40.0F)), kInvalid, "vox_offset is 40"},
        Refused{"pixdim", Nifti(80, Bytes(0.0F)), kInvalid, "positive"},
        Refused{"scale", Nifti(112, Bytes(std::numeric_limits<float>::infinity())), kInvalid,
                "scl_slope"},
        Refused{"magic", Nifti(344, std::string(4, '\0')), kInvalid, "Analyze"}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Npy, RefusedHeader,
    ::testing::Values(
        Refused{"long_double",
                Npy("{'descr': '<f16', 'fortran_order': False, 'shape': (2, 2, 3), }"), kInvalid,
                "'<f16'"},
        Refused{"complex", Npy("{'descr': '<c8', 'fortran_order': False, 'shape': (2, 2, 3), }"),
                kInvalid, "'<c8'"},
        Refused{"record", Npy("{'descr': [('a', '<u1')], 'fortran_order': False, 'shape': (2,), }"),
                kInvalid, "records; save one of their fields: numpy.save(FILE, array['a'])"},
        Refused{"channels",
                Npy("{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 2, 3), }"), kInvalid,
                "4 axes"},
        Refused{"no_shape", Npy("{'descr': '|u1', 'fortran_order': False}"), kInvalid,
                "lacks 'shape'"},
        Refused{"scalar", Npy("{'descr': '|u1', 'fortran_order': False, 'shape': (), }"), kInvalid,
                "no axes"}),
    [](const auto& info) { return std::string(info.param.name); });

INSTANTIATE_TEST_SUITE_P(
    Vol, RefusedHeader,
    ::testing::Values(Refused{"size", "X: 3\nY: 2\nZ: two\nVoxel-Size: 1\n.\n", kInvalid, "'two'"},
                      Refused{"bytes", "X: 3\nY: 2\nZ: 2\nVoxel-Size: 3\n.\n", kInvalid, "3 bytes"},
                      Refused{"version", "X: 3\nY: 2\nZ: 2\nVoxel-Size: 1\nVersion: 4\n.\n",
                              kInvalid, "Version is 4"}),
    [](const auto& info) { return std::string(info.param.name); });

TEST(ImageLimits, RefuseWhatIsLargerBeforeMemoryIsTaken) {
  ImageOptions options;
  options.limits.max_voxels = 11;
  const std::string bytes = testing::Nifti1Header() + Counting<uint8_t>(12);
  EXPECT_EQ(ReadBytes(bytes, options).status().code(), kExhausted);
  options.limits = {};
  options.limits.max_slice_voxels = 5;
  EXPECT_EQ(ReadBytes(bytes, options).status().code(), kExhausted);
}

}  // namespace
}  // namespace bccskel::image_headers
