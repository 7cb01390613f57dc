#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "absl/strings/escaping.h"
#include "absl/strings/str_format.h"
#include "absl/strings/str_replace.h"
#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/mesh_bytes.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/support/deflated.h"

namespace bccskel {
namespace {

using ::testing::HasSubstr;

TriangleMesh GiftiBox() { return testing::Box({-1, 0.5, 2}, {3, 4, 5}); }

struct GiftiLayout {
  const char* name;
  const char* encoding;
  std::endian order = std::endian::little;
};
void PrintTo(const GiftiLayout& layout, std::ostream* out) { *out << layout.name; }

template <typename Number>
std::string GiftiArray(const GiftiLayout& layout, const char* intent, const char* type,
                       const std::vector<Number>& numbers) {
  const std::string bytes = testing::BytesOf(numbers, layout.order);
  const std::string encoding = layout.encoding;
  const std::string data = encoding == "ASCII" ? testing::TextOf(numbers)
                           : encoding == "Base64Binary"
                               ? absl::Base64Escape(bytes)
                               : absl::Base64Escape(testing::Deflated(bytes));
  return absl::StrFormat(
      "<DataArray Intent='NIFTI_INTENT_%s' DataType='NIFTI_TYPE_%s' "
      "ArrayIndexingOrder='RowMajorOrder' Dimensionality='2' Dim0='%d' Dim1='3' Encoding='%s' "
      "Endian='%s' ExternalFileName='' ExternalFileOffset=''>\n<MetaData/>"
      "<CoordinateSystemTransformMatrix><MatrixData>2 0 0 9 0 2 0 9 0 0 2 9 0 0 0 1</MatrixData>"
      "</CoordinateSystemTransformMatrix>\n<Data>%s</Data></DataArray>\n",
      intent, type, numbers.size() / 3, encoding,
      layout.order == std::endian::big ? "BigEndian" : "LittleEndian", data);
}

std::string ToGifti(const GiftiLayout& layout, const TriangleMesh& mesh) {
  return "<?xml version='1.0' encoding='UTF-8'?>\n<!DOCTYPE GIFTI SYSTEM "
         "'http://gifti.projects.nitrc.org/gifti.dtd'>\n<GIFTI Version='1.0' "
         "NumberOfDataArrays='2'>\n<MetaData><MD><Name><![CDATA[a]]></Name></MD></MetaData>" +
         GiftiArray(layout, "TRIANGLE", "INT32", testing::CornersOf<int32_t>(mesh)) +
         GiftiArray(layout, "POINTSET", "FLOAT32", testing::CoordinatesOf<float>(mesh)) +
         "</GIFTI>\n";
}

class GiftiLayouts : public ::testing::TestWithParam<GiftiLayout> {};

TEST_P(GiftiLayouts, GiveTheMeshWithoutTheTransform) {
  const auto mesh = ParseMesh(ToGifti(GetParam(), GiftiBox()), "a.bin");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, GiftiBox());
}

TEST_P(GiftiLayouts, AreRefusedWhenCut) {
  const std::string bytes = ToGifti(GetParam(), GiftiBox());
  for (size_t size = 100; size + 12 < bytes.size(); size += 3) {
    EXPECT_EQ(ParseMesh(bytes.substr(0, size), "a.gii").status().code(),
              absl::StatusCode::kInvalidArgument)
        << size;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, GiftiLayouts,
    ::testing::Values(GiftiLayout{"text", "ASCII"}, GiftiLayout{"base64", "Base64Binary"},
                      GiftiLayout{"base64_big", "Base64Binary", std::endian::big},
                      GiftiLayout{"zlib", "GZipBase64Binary"},
                      GiftiLayout{"zlib_big", "GZipBase64Binary", std::endian::big}),
    [](const auto& info) { return info.param.name; });

TEST(GiftiReader, ReadsColumnMajorArrays) {
  const TriangleMesh box = GiftiBox();
  std::vector<float> columns;
  for (size_t axis = 0; axis < 3; ++axis) {
    for (const auto& vertex : box.vertices) columns.push_back(static_cast<float>(vertex[axis]));
  }
  const GiftiLayout layout = {"", "ASCII"};
  std::string points = GiftiArray(layout, "POINTSET", "FLOAT32", columns);
  points = absl::StrReplaceAll(points, {{"RowMajor", "ColumnMajor"}});
  const auto mesh = ParseMesh(
      "<GIFTI>" + points +
          GiftiArray(layout, "TRIANGLE", "INT32", testing::CornersOf<int32_t>(box)) + "</GIFTI>",
      "a.gii");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, box);
}

struct GiftiRefusal {
  const char* what;
  const char* part;
  const char* by;
  const char* message;
};
void PrintTo(const GiftiRefusal& refusal, std::ostream* out) { *out << refusal.what; }

class GiftiRefusals : public ::testing::TestWithParam<GiftiRefusal> {};

TEST_P(GiftiRefusals, NameWhatIsWrong) {
  const std::string text = ToGifti({"", "GZipBase64Binary"}, GiftiBox());
  ASSERT_THAT(text, HasSubstr(GetParam().part));
  const auto mesh =
      ParseMesh(absl::StrReplaceAll(text, {{GetParam().part, GetParam().by}}), "a.gii");
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << mesh.status();
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, GiftiRefusals,
    ::testing::Values(
        GiftiRefusal{"NoPoints", "INTENT_POINTSET", "INTENT_SHAPE", "no array NIFTI_INTENT_POINT"},
        GiftiRefusal{"NoTriangles", "INTENT_TRIANGLE", "INTENT_LABEL", "no array NIFTI_INTENT_TRI"},
        GiftiRefusal{"TwoSurfaces", "INTENT_TRIANGLE", "INTENT_POINTSET", "several arrays"},
        GiftiRefusal{"ExternalFile", "GZipBase64Binary", "ExternalFileBinary",
                     "Encoding 'ExternalFileBinary' is not read"},
        GiftiRefusal{"Endian", "LittleEndian", "Middle", "Endian 'Middle'"},
        GiftiRefusal{"Type", "TYPE_FLOAT32", "TYPE_RGB24", "'NIFTI_TYPE_RGB24'"},
        GiftiRefusal{"Columns", "Dim1='3'", "Dim1='2'", "8 x 2 values"},
        GiftiRefusal{"NegativeRows", "Dim0='8'", "Dim0='-8'", "is '-8'"},
        GiftiRefusal{"HugeRows", "Dim0='8'", "Dim0='99999999999'", "99999999999 x 3"},
        GiftiRefusal{"ManyRows", "Dim0='8'", "Dim0='4000000000'", "not possible"},
        GiftiRefusal{"MoreRows", "Dim0='8'", "Dim0='9'", "is cut"},
        GiftiRefusal{"FewerRows", "Dim0='8'", "Dim0='7'", "holds more"},
        GiftiRefusal{"NoData", "<Data>", "<Data/><Data>", "zlib data of 0 bytes"}),
    [](const auto& info) { return info.param.what; });

}  // namespace
}  // namespace bccskel
