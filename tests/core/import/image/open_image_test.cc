#include "core/import/image/open_image.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "absl/strings/str_format.h"
#include "tests/core/import/image/image_bytes.h"
#include "tests/core/import/image/image_folder.h"

namespace bccskel {
namespace {

using testing::Bytes;
using testing::CountedTo;
using testing::Counting;
using testing::Deflated;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::ReadBytes;
using testing::Wrapping;

std::string Npy(const std::string& dictionary, const std::string& elements) {
  return std::string("\x93NUMPY\x01\x00", 8) + Bytes(static_cast<uint16_t>(dictionary.size())) +
         dictionary + elements;
}

TEST(OpenImage, ReadsNrrdWithDirectionsAndUnits) {
  const auto image = MustRead(ReadBytes(
      "NRRD0005\n# comment\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\n"
      "sizes: 3 2 2\nspace directions: (-1,0,0) (0, -2, 0) (0,0,3)\nencoding: raw\n"
      "space origin: (10,20,-30)\nspace units: \"mm\" \"mm\" \"mm\"\nkey:=value\n\n" +
      Counting<uint8_t>(12)));
  EXPECT_EQ(image.values, CountedTo(12));
  EXPECT_EQ(image.info.size, (ImageSize{3, 2, 2}));
  EXPECT_EQ(image.info.format, "NRRD");
  EXPECT_EQ(image.info.unit, "mm");
  EXPECT_EQ(image.info.world, "LPS");
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 3));
  EXPECT_THAT(image.info.placement.ToWorld(2 * 2, 2 * 1, 2 * 1), ElementsAre(8, 18, -27));
}

TEST(OpenImage, ReadsNrrdWithAnAxisOfOneComponentInFront) {
  for (const std::string place :
       {"space directions: none (2,0,0) (0,3,0) (0,0,4)\nspace origin: (1,2,3)\nspace: RAS\n",
        "spacings: nan 2 3 4\n"}) {
    const auto image = MustRead(ReadBytes("NRRD0004\ntype: uint8\ndimension: 4\nsizes: 1 3 2 2\n" +
                                          place + "encoding: raw\n\n" + Counting<uint8_t>(12)));
    EXPECT_EQ(image.values, CountedTo(12));
    EXPECT_EQ(image.info.size, (ImageSize{3, 2, 2}));
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(2, 3, 4));
  }
}

// (0.36, 0.48, 0.8) has the length 1, in doubles 0.99999999999999989.
TEST(OpenImage, GivesObliqueAxesTheSpacingThatIsStated) {
  const auto meta = MustRead(ReadBytes(
      "ObjectType = Image\nNDims = 3\nTransformMatrix = 0.36 0.48 0.8 -0.8 0.6 0 -0.48 -0.64 0.6\n"
      "Offset = 5 6 7\nElementSpacing = 0.7 0.7 0.7\nDimSize = 3 2 2\nElementType = MET_UCHAR\n"
      "ElementDataFile = LOCAL\n" +
      Counting<uint8_t>(12)));
  EXPECT_THAT(meta.info.placement.spacing, ElementsAre(0.7, 0.7, 0.7));
  const auto nrrd = MustRead(
      ReadBytes("NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nspace: RAS\nencoding: raw\n"
                "space directions: (0.252,0.336,0.56) (-0.56,0.42,0) (-0.336,-0.448,0.42)\n\n" +
                Counting<uint8_t>(12)));
  EXPECT_THAT(nrrd.info.placement.spacing, ElementsAre(0.7, 0.7, 0.7));
}

TEST(OpenImage, GivesTurnedNiftiTheSpacingOfItsPixdim) {
  const auto header = [](int16_t qform, int16_t sform) {
    std::string bytes = testing::Nifti1Header();
    const auto put = [&bytes](size_t at, const std::string& value) {
      bytes.replace(at, value.size(), value);
    };
    put(76, Bytes(1.0F) + Bytes(0.7F) + Bytes(0.7F) + Bytes(0.7F));
    put(252, Bytes(qform) + Bytes(sform));
    put(256, Bytes(0.1F) + Bytes(0.2F) + Bytes(0.3F));
    const auto row = [](double x, double y, double z) {
      const auto entry = [](double c) { return Bytes(static_cast<float>(0.7F * c)); };
      return entry(x) + entry(y) + entry(z) + Bytes(1.0F);
    };
    put(280, row(0.36, -0.8, -0.48) + row(0.48, 0.6, -0.64) + row(0.8, 0, 0.6));
    return bytes;
  };
  for (const std::string& bytes : {header(1, 0), header(0, 1)}) {
    const auto image = MustRead(ReadBytes(bytes + Counting<uint8_t>(12)));
    const double exact = 0.7F;
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(exact, exact, exact));
    const auto& direction = image.info.placement.direction;
    for (size_t axis = 0; axis < 3; ++axis) {
      const double x = direction[axis], y = direction[3 + axis], z = direction[6 + axis];
      EXPECT_NEAR(x * x + y * y + z * z, 1, 1e-15);
    }
  }
}

TEST(OpenImage, TurnsNiftiByAQuaternionLongerThanOne) {
  std::string header = testing::Nifti1Header();
  const auto put = [&](size_t at, const std::string& value) {
    header.replace(at, value.size(), value);
  };
  put(252, Bytes<int16_t>(1) + Bytes<int16_t>(0));
  put(256, Bytes(1.2F) + Bytes(0.0F) + Bytes(0.0F));  // half a turn about x
  const auto image = MustRead(ReadBytes(header + Counting<uint8_t>(12)));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 3));
  EXPECT_THAT(image.info.placement.direction, ElementsAre(1, 0, 0, 0, -1, 0, 0, 0, -1));
}

TEST(OpenImage, ReadsNrrdOfOneSliceAnywhereInSpace) {
  const auto image = MustRead(
      ReadBytes("NRRD0004\ntype: uint8\ndimension: 2\nsizes: 3 2\nspace: RAS\nencoding: raw\n"
                "space directions: (0,0.5,0) (0,0,0.25)\n\n" +
                Counting<uint8_t>(6)));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(0.5, 0.25, 1));
  EXPECT_THAT(image.info.placement.direction, ElementsAre(0, 0, 1, 1, 0, 0, 0, 1, 0));
}

TEST(OpenImage, ReadsNiftiOfOneSliceWithoutADistanceToTheNext) {
  std::string header = testing::Nifti1Header();
  header.replace(46, 2, Bytes<int16_t>(1));
  header.replace(88, 4, Bytes(0.0F));
  const auto image = MustRead(ReadBytes(header + Counting<uint8_t>(6)));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 1));
}

TEST(OpenImage, ReadsMetaImageWhoseRowsAreTheAxes) {
  // Axis 0 points along y, axis 1 against x.
  const auto image = MustRead(
      ReadBytes("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = True\n"
                "TransformMatrix = 0 1 0 -1 0 0 0 0 1\nOffset = 5 6 7\nElementSpacing = 1 2 3\n"
                "DimSize = 3 2 2\nElementType = MET_USHORT\nElementDataFile = LOCAL\n" +
                Counting<uint16_t>(12, std::endian::big)));
  EXPECT_EQ(image.values, CountedTo(12));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 3));
  EXPECT_THAT(image.info.placement.ToWorld(2 * 2, 0, 0), ElementsAre(5, 8, 7));
  EXPECT_THAT(image.info.placement.ToWorld(0, 2 * 1, 2 * 1), ElementsAre(3, 6, 10));
}

TEST(OpenImage, ReadsInrimage) {
  const auto image = MustRead(ReadBytes(
      "#INRIMAGE-4#{\nXDIM=3\nYDIM=2\nZDIM=2\nVDIM=1\nTYPE=signed fixed\nPIXSIZE=16 bits\n"
      "SCALE=2**0\nCPU=sun\nVX=0.5\nVY=1\nVZ=2\nTX=1\nTY=2\nTZ=3\n\n##}\n" +
      Counting<int16_t>(12, std::endian::big)));
  EXPECT_EQ(image.values, CountedTo(12));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(0.5, 1, 2));
  EXPECT_THAT(image.info.placement.origin, ElementsAre(1, 2, 3));
}

TEST(OpenImage, ReadsVolOfVersions2And3AndPutsItsCenter) {
  const std::string front =
      "Center-X: 10\nCenter-Y: 10\nCenter-Z: 10\nX: 3\nY: 2\nZ: 2\nVoxel-Size: 1\n"
      "Alpha-Color: 0\nInt-Endian: 0123\nVoxel-Endian: 0\nVersion: ";
  const std::string plain = front + "2\n.\n" + Counting<uint8_t>(12);
  const std::string packed = front + "3\n.\n" + Deflated(Counting<uint8_t>(12), Wrapping::kZlib);
  for (const std::string& bytes : {plain, packed}) {
    const auto image = MustRead(ReadBytes(bytes));
    EXPECT_EQ(image.values, CountedTo(12));
    EXPECT_THAT(image.info.placement.origin, ElementsAre(9, 10, 10));
  }
}

TEST(OpenImage, ReadsNpyWithTheLastAxisAsX) {
  const auto image = MustRead(ReadBytes(Npy(
      "{'descr': '|u1', 'fortran_order': False, 'shape': (2, 2, 3), }", Counting<uint8_t>(12))));
  EXPECT_EQ(image.info.size, (ImageSize{3, 2, 2}));
  EXPECT_EQ(image.values, CountedTo(12));
}

TEST(OpenImage, ReadsNpyOfHalfPrecision) {
  const std::string dictionary = "{'descr': '<f2', 'fortran_order': False, 'shape': (1, 2, 4), }";
  std::string elements;
  for (const int half : {0x0000, 0x3c00, 0xbe00, 0x7bff, 0x0001, 0x8400, 0xfc00, 0x7e01}) {
    elements += Bytes(static_cast<uint16_t>(half));
  }
  const auto image = MustRead(ReadBytes(Npy(dictionary, elements)));
  EXPECT_EQ(image.info.type, VoxelType::kFloat32);
  EXPECT_THAT(image.values,
              ElementsAre(0, 1, -1.5, 65504, 0x1p-24, -0x1p-14, -HUGE_VAL, ::testing::IsNan()));
}

TEST(OpenImage, ReadsNpyInFortranOrderAsTheSameArray) {
  // Element (z, y, x) of a 2 x 3 x 4 array is 12 z + 4 y + x; in the file, z varies fastest.
  std::string elements;
  for (int x = 0; x < 4; ++x) {
    for (int y = 0; y < 3; ++y) {
      for (int z = 0; z < 2; ++z) elements += Bytes<int32_t>(12 * z + 4 * y + x, std::endian::big);
    }
  }
  const std::string bytes =
      Npy("{'descr': '>i4', 'fortran_order': True, 'shape': (2, 3, 4), }", elements);
  // A slice has 48 bytes: both at once, and one by one.
  for (const uint64_t slab : {uint64_t{1} << 20, uint64_t{50}, uint64_t{1}}) {
    ImageOptions options;
    options.limits.max_slab_bytes = slab;
    const auto image = MustRead(ReadBytes(bytes, options));
    EXPECT_EQ(image.info.size, (ImageSize{4, 3, 2}));
    EXPECT_EQ(image.values, CountedTo(24)) << slab;
  }
}

TEST(OpenImage, DropsAxesOfLengthOneOfNpyArrays) {
  for (const char* shape : {"(1, 2, 2, 3)", "(2, 2, 3, 1)", "(1, 1, 2, 2, 3, 1)"}) {
    const auto image = ReadBytes(
        Npy(absl::StrFormat("{'descr': '|u1', 'fortran_order': False, 'shape': %s, }", shape),
            Counting<uint8_t>(12)));
    ASSERT_TRUE(image.ok()) << shape << image.status();
    EXPECT_EQ(image->info.size, (ImageSize{3, 2, 2})) << shape;
  }
}

TEST(OpenImage, ReadsNifti1InBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    const auto image = MustRead(ReadBytes(testing::Nifti1Header(order) + Counting<uint8_t>(12)));
    EXPECT_EQ(image.values, CountedTo(12));
    EXPECT_EQ(image.info.format, "NIfTI-1");
    EXPECT_EQ(image.info.unit, "mm");
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 3));
  }
}

// Readers differ on where such an image lies and even on whether its x points left.
TEST(OpenImage, TakesTheWorldOfNiftiForRasOnlyWhereACodeStatesIt) {
  for (const auto& [qform, sform] : {std::pair(0, 0), {1, 0}, {0, 4}, {2, 1}}) {
    std::string header = testing::Nifti1Header();
    header.replace(
        252, 4,
        Bytes<int16_t>(static_cast<int16_t>(qform)) + Bytes<int16_t>(static_cast<int16_t>(sform)));
    const float srow[12] = {1, 0, 0, 0, 0, 2, 0, 0, 0, 0, 3, 0};
    for (size_t n = 0; n < 12; ++n) header.replace(280 + 4 * n, 4, Bytes(srow[n]));
    const auto image = MustRead(ReadBytes(header + Counting<uint8_t>(12)));
    EXPECT_EQ(image.info.world, qform + sform > 0 ? "RAS" : "") << qform << sform;
    EXPECT_THAT(image.info.placement.spacing, ElementsAre(1, 2, 3));
  }
}

TEST(OpenImage, PrefersTheSformToTheQform) {
  std::string header = testing::Nifti1Header();
  header.replace(252, 4, Bytes<int16_t>(1) + Bytes<int16_t>(2));
  const float srow[12] = {0, 4, 0, 10, 5, 0, 0, 20, 0, 0, 6, 30};
  for (size_t n = 0; n < 12; ++n) header.replace(280 + 4 * n, 4, Bytes(srow[n]));
  const auto image = MustRead(ReadBytes(header + Counting<uint8_t>(12)));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(5, 4, 6));
  EXPECT_THAT(image.info.placement.ToWorld(2, 0, 0), ElementsAre(10, 25, 30));
}

TEST(OpenImage, ScalesNiftiValues) {
  std::string header = testing::Nifti1Header();
  header.replace(112, 8, Bytes<float>(0.5F) + Bytes<float>(-1.0F));
  const auto image = MustRead(ReadBytes(header + Counting<uint8_t>(12)));
  EXPECT_EQ(image.info.type, VoxelType::kFloat64);
  EXPECT_EQ(image.values[0], -1);
  EXPECT_EQ(image.values[11], 4.5);
}

TEST(OpenImage, ReadsGzipFilesOfAnyFormatAndOfSeveralMembers) {
  const std::string bytes = testing::Nifti1Header() + Counting<uint8_t>(12);
  const std::string one = Deflated(bytes, Wrapping::kGzip);
  const std::string two = Deflated(bytes.substr(0, 355), Wrapping::kGzip) +
                          Deflated(bytes.substr(355), Wrapping::kGzip);
  for (const std::string& packed : {one, two}) {
    const auto image = MustRead(ReadBytes(packed));
    EXPECT_EQ(image.values, CountedTo(12));
  }
}

struct Typed {
  VoxelType type;
  std::string (*counting)(size_t, std::endian);
};

class EveryType : public ::testing::TestWithParam<Typed> {};

TEST_P(EveryType, IsReadInBothByteOrders) {
  for (const std::endian order : {std::endian::little, std::endian::big}) {
    ImageOptions options;
    options.raw = {
        .size = {3, 5, 2}, .type = GetParam().type, .byte_order = order, .header_bytes = 7};
    const std::string bytes = "header." + GetParam().counting(30, order);
    for (const std::string& stored : {bytes, Deflated(bytes, Wrapping::kGzip)}) {
      const auto image = MustRead(ReadBytes(stored, options));
      EXPECT_EQ(image.info.type, GetParam().type);
      EXPECT_EQ(image.values, CountedTo(30));
    }
  }
}

TEST(OpenImage, SaysWhichSizeOfRawVoxelsDoesNotFit) {
  ImageOptions options;
  options.raw = {.size = {3, 5, 2}};
  for (const size_t voxels : {29u, 31u}) {
    const auto image = ReadBytes(Counting<uint8_t>(voxels), options);
    EXPECT_EQ(image.status().code(), absl::StatusCode::kInvalidArgument);
    EXPECT_THAT(std::string(image.status().message()),
                HasSubstr("--raw-size, --raw-type and --raw-header make 30 bytes, the file holds " +
                          std::to_string(voxels)));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Raw, EveryType,
    ::testing::Values(
        Typed{VoxelType::kUint8, Counting<uint8_t>}, Typed{VoxelType::kInt8, Counting<int8_t>},
        Typed{VoxelType::kUint16, Counting<uint16_t>}, Typed{VoxelType::kInt16, Counting<int16_t>},
        Typed{VoxelType::kUint32, Counting<uint32_t>}, Typed{VoxelType::kInt32, Counting<int32_t>},
        Typed{VoxelType::kUint64, Counting<uint64_t>}, Typed{VoxelType::kInt64, Counting<int64_t>},
        Typed{VoxelType::kFloat32, Counting<float>}, Typed{VoxelType::kFloat64, Counting<double>}),
    [](const auto& info) { return std::string(VoxelTypeName(info.param.type)); });

TEST(OpenImage, TakesTheSpacingFromTheOptions) {
  ImageOptions options;
  options.spacing = {0.5, 0.25, 2};
  const auto image = MustRead(ReadBytes(testing::Nifti1Header() + Counting<uint8_t>(12), options));
  EXPECT_THAT(image.info.placement.spacing, ElementsAre(0.5, 0.25, 2));
  options.spacing = {0, 1, 1};
  EXPECT_EQ(ReadBytes(testing::Nifti1Header() + Counting<uint8_t>(12), options).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST(OpenImage, ReadsVoxelsFromAFileBesideTheHeaderOnly) {
  const testing::ImageFolder folder("detached");
  folder.Write("voxels.raw", "skip" + Counting<uint8_t>(12));
  folder.Write("inner/voxels.raw", "skip" + Counting<uint8_t>(12));
  const auto nrrd = [&folder](const std::string& place) {
    folder.Write("a.nhdr", "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 3 2 2\nencoding: raw\n" +
                               place + "\n");
    return folder.path() + "/a.nhdr";
  };
  for (const char* place :
       {"data file: voxels.raw\nbyte skip: 4", "byte skip: -1\ndata file: ./voxels.raw"}) {
    const auto image = MustRead(testing::ReadAll(OpenImage(nrrd(place))));
    EXPECT_EQ(image.values, CountedTo(12));
  }
  for (const char* place : {"inner/voxels.raw", "../detached/voxels.raw", "/etc/passwd"}) {
    const auto status = OpenImage(nrrd(absl::StrFormat("data file: %s", place))).status();
    EXPECT_THAT(std::string(status.message()), HasSubstr("only a file beside the header"));
  }
  folder.Write("a.mhd",
               "NDims = 3\nDimSize = 3 2 2\nElementType = MET_UCHAR\nHeaderSize = 4\n"
               "ElementDataFile = voxels.raw");
  const auto image = MustRead(testing::ReadAll(OpenImage(folder.path() + "/a.mhd")));
  EXPECT_EQ(image.values, CountedTo(12));
}

TEST(OpenImage, RefusesFoldersAndMissingFilesByName) {
  const auto folder = OpenImage(::testing::TempDir()).status();
  EXPECT_EQ(folder.code(), absl::StatusCode::kInvalidArgument);
  EXPECT_THAT(std::string(folder.message()), HasSubstr("folder"));
  const auto missing = OpenImage("/no/such/file.nii").status();
  EXPECT_EQ(missing.code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(std::string(missing.message()), HasSubstr("/no/such/file.nii"));
}

}  // namespace
}  // namespace bccskel
