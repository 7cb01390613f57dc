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

TriangleMesh VtkBox() { return testing::Box({-1, 0.5, 2}, {3, 4, 5}); }

void ExpectVtkMesh(const std::string& bytes, const TriangleMesh& expected) {
  const auto mesh = ParseMesh(bytes, "a.bin");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, expected);
}

// The number of corners before the corners of each triangle.
std::vector<int32_t> CountedCells(const TriangleMesh& mesh) {
  std::vector<int32_t> numbers;
  for (const auto& triangle : mesh.triangles) {
    numbers.push_back(3);
    for (const uint32_t corner : triangle) numbers.push_back(static_cast<int32_t>(corner));
  }
  return numbers;
}

std::vector<int64_t> EndsOf(const TriangleMesh& mesh, int64_t first) {
  std::vector<int64_t> ends;
  const auto last = static_cast<int64_t>(3 * mesh.triangles.size());
  for (int64_t end = first; end <= last; end += 3) ends.push_back(end);
  return ends;
}

// A legacy file in text or in bytes.
class LegacyFile {
 public:
  LegacyFile(const char* version, bool binary) : binary_(binary) {
    text_ = absl::StrFormat("# vtk DataFile Version %s\na title\n%s\n", version,
                            binary ? "BINARY" : "ASCII");
  }

  LegacyFile& Add(const std::string& line) {
    text_ += line + '\n';
    return *this;
  }
  template <typename Number>
  LegacyFile& Add(const std::vector<Number>& numbers) {
    text_ += (binary_ ? testing::BytesOf(numbers, std::endian::big) : testing::TextOf(numbers));
    text_ += '\n';
    return *this;
  }
  const std::string& text() const { return text_; }

 private:
  bool binary_;
  std::string text_;
};

std::string OldLayout(const TriangleMesh& mesh, bool binary) {
  const size_t count = mesh.triangles.size();
  return LegacyFile("3.0", binary)
      .Add("DATASET POLYDATA")
      .Add(absl::StrFormat("POINTS %d float", mesh.vertices.size()))
      .Add(testing::CoordinatesOf<float>(mesh))
      .Add("LINES 1 3")
      .Add(std::vector<int32_t>{2, 0, 1})
      .Add(absl::StrFormat("POLYGONS %d %d", count, 4 * count))
      .Add(CountedCells(mesh))
      .Add("CELL_DATA 12")
      .text();
}

std::string NewLayout(const TriangleMesh& mesh, bool binary) {
  const auto ends = EndsOf(mesh, 0);
  return LegacyFile("5.1", binary)
      .Add("DATASET POLYDATA")
      .Add("FIELD FieldData 1\nTIME 1 2 double")
      .Add(std::vector<double>{1, 2})
      .Add(absl::StrFormat("POINTS %d double", mesh.vertices.size()))
      .Add(testing::CoordinatesOf<double>(mesh))
      .Add("METADATA\nINFORMATION 1\nNAME L2_NORM_RANGE LOCATION vtkDataArray\nDATA 2 0 1\n")
      .Add("LINES 2 2\nOFFSETS vtktypeint64")
      .Add(std::vector<int64_t>{0, 2})
      .Add("CONNECTIVITY vtktypeint64")
      .Add(std::vector<int64_t>{0, 1})
      .Add(absl::StrFormat("POLYGONS %d %d\nOFFSETS vtktypeint64", ends.size(), ends.back()))
      .Add(ends)
      .Add("CONNECTIVITY vtktypeint64")
      .Add(testing::CornersOf<int64_t>(mesh))
      .Add("POINT_DATA 8")
      .text();
}

TEST(VtkLegacyReader, ReadsBothLayoutsInTextAndBytes) {
  for (const bool binary : {false, true}) {
    SCOPED_TRACE(binary);
    ExpectVtkMesh(OldLayout(VtkBox(), binary), VtkBox());
    ExpectVtkMesh(NewLayout(VtkBox(), binary), VtkBox());
  }
}

TEST(VtkLegacyReader, ReadsLineEndsOfWindows) {
  for (const std::string& text : {OldLayout(VtkBox(), false), NewLayout(VtkBox(), false)}) {
    ExpectVtkMesh(absl::StrReplaceAll(text, {{"\n", "\r\n"}}), VtkBox());
  }
}

TEST(VtkLegacyReader, ReadsIntegerPointsAndStrips) {
  for (const bool binary : {false, true}) {
    const std::string text =
        LegacyFile("2.0", binary)
            .Add("DATASET POLYDATA\nPOINTS 5 short")
            .Add(std::vector<int16_t>{0, 0, 0, 1, 0, 0, 0, -1, 0, 1, 1, 0, 0, 2, 0})
            .Add("TRIANGLE_STRIPS 1 7")
            .Add(std::vector<int32_t>{6, 0, 1, 2, 3, 3, 4})
            .text();
    const auto mesh = ParseMesh(text, "a.vtk");
    ASSERT_TRUE(mesh.ok()) << mesh.status();
    EXPECT_EQ(mesh->vertices[2], (TriangleMesh::Vertex{0, -1, 0}));
    // The two triangles with point 3 twice are none.
    EXPECT_THAT(mesh->triangles, ::testing::ElementsAre(TriangleMesh::Triangle{0, 1, 2},
                                                        TriangleMesh::Triangle{2, 1, 3}));
  }
}

enum class Stored { kText, kInline, kRaw, kBase64 };
struct VtpLayout {
  const char* name;
  Stored stored;
  std::endian order = std::endian::little;
  bool long_headers = false;
  bool zlib = false;
};
void PrintTo(const VtpLayout& layout, std::ostream* out) { *out << layout.name; }

// Writes the arrays of a file and what is appended to it.
class VtpWriter {
 public:
  explicit VtpWriter(const VtpLayout& layout) : layout_(layout) {}

  template <typename Number>
  std::string Array(const char* type, const char* name, const std::vector<Number>& numbers) {
    const std::string head = absl::StrFormat("<DataArray type='%s' Name='%s' format=", type, name);
    if (layout_.stored == Stored::kText) {
      return head + "'ascii'>\n" + testing::TextOf(numbers) + "</DataArray>\n";
    }
    const bool raw = layout_.stored == Stored::kRaw;
    const std::string bytes = Encoded(testing::BytesOf(numbers, layout_.order), raw);
    if (layout_.stored == Stored::kInline) {
      return head + "'binary'>\n  " + bytes + "\n</DataArray>\n";
    }
    const size_t offset = appended_.size();
    appended_ += bytes;
    return head + absl::StrFormat("'appended' offset='%d'/>\n", offset);
  }

  std::string File(const std::string& pieces) const {
    std::string text = absl::StrFormat(
        "<?xml version='1.0'?>\n<VTKFile type='PolyData' version='1.0' byte_order='%s' "
        "header_type='%s'%s>\n<PolyData>%s</PolyData>\n",
        layout_.order == std::endian::big ? "BigEndian" : "LittleEndian",
        layout_.long_headers ? "UInt64" : "UInt32",
        layout_.zlib ? " compressor='vtkZLibDataCompressor'" : "", pieces);
    if (layout_.stored == Stored::kRaw || layout_.stored == Stored::kBase64) {
      text += absl::StrFormat("<AppendedData encoding='%s'>\n_%s\n</AppendedData>\n",
                              layout_.stored == Stored::kRaw ? "raw" : "base64", appended_);
    }
    return text + "</VTKFile>\n";
  }

 private:
  std::string Words(const std::vector<uint64_t>& words) const {
    if (layout_.long_headers) return testing::BytesOf(words, layout_.order);
    return testing::BytesOf(std::vector<uint32_t>(words.begin(), words.end()), layout_.order);
  }

  // Blocks of 40 bytes, so that there are several and a part of one.
  std::string Encoded(const std::string& bytes, bool raw) const {
    const auto text = [&](const std::string& plain) {
      return raw ? plain : absl::Base64Escape(plain);
    };
    if (!layout_.zlib) return text(Words({bytes.size()}) + bytes);
    constexpr size_t kBlock = 40;
    std::vector<uint64_t> header = {(bytes.size() + kBlock - 1) / kBlock, kBlock,
                                    bytes.size() % kBlock};
    std::string blocks;
    for (size_t at = 0; at < bytes.size(); at += kBlock) {
      const std::string block = testing::Deflated(bytes.substr(at, kBlock));
      header.push_back(block.size());
      blocks += block;
    }
    return text(Words(header)) + text(blocks);
  }

  VtpLayout layout_;
  std::string appended_;
};

std::string VtpPiece(VtpWriter& writer, const TriangleMesh& mesh) {
  std::string piece = absl::StrFormat("<Piece NumberOfPoints='%d' NumberOfPolys='%d'>\n",
                                      mesh.vertices.size(), mesh.triangles.size());
  piece += "<PointData>" + writer.Array("Float32", "x", std::vector<float>(8)) + "</PointData>";
  piece += "<Points>" + writer.Array("Float64", "Points", testing::CoordinatesOf<double>(mesh));
  piece += "</Points><Polys>";
  piece += writer.Array("Int32", "connectivity", testing::CornersOf<int32_t>(mesh));
  piece += writer.Array("Int64", "offsets", EndsOf(mesh, 3)) + "</Polys><Strips>";
  piece += writer.Array("Int64", "connectivity", std::vector<int64_t>());
  return piece + writer.Array("Int64", "offsets", std::vector<int64_t>()) + "</Strips></Piece>";
}

class VtpLayouts : public ::testing::TestWithParam<VtpLayout> {};

TEST_P(VtpLayouts, GiveTheMeshOfAllPieces) {
  VtpWriter writer(GetParam());
  const TriangleMesh other = testing::Tetrahedron({9, 0, 0}, {10, 0, 0}, {9, 1, 0}, {9, 0, 1});
  const std::string pieces = VtpPiece(writer, VtkBox()) + VtpPiece(writer, other);
  ExpectVtkMesh(writer.File(pieces), testing::Merged(VtkBox(), other));
}

TEST_P(VtpLayouts, AreRefusedWhenCut) {
  VtpWriter writer(GetParam());
  const std::string bytes = writer.File(VtpPiece(writer, VtkBox()));
  for (size_t size = bytes.size() / 8; size < bytes.size() * 3 / 4; size += 3) {
    EXPECT_EQ(ParseMesh(bytes.substr(0, size), "a.vtp").status().code(),
              absl::StatusCode::kInvalidArgument)
        << size;
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, VtpLayouts,
    ::testing::Values(VtpLayout{"text", Stored::kText}, VtpLayout{"inline", Stored::kInline},
                      VtpLayout{"inline_big_long", Stored::kInline, std::endian::big, true},
                      VtpLayout{"inline_zlib", Stored::kInline, std::endian::little, false, true},
                      VtpLayout{"inline_zlib_long", Stored::kInline, std::endian::big, true, true},
                      VtpLayout{"raw", Stored::kRaw},
                      VtpLayout{"raw_zlib_long", Stored::kRaw, std::endian::little, true, true},
                      VtpLayout{"raw_big", Stored::kRaw, std::endian::big},
                      VtpLayout{"base64_long", Stored::kBase64, std::endian::little, true},
                      VtpLayout{"base64_zlib", Stored::kBase64, std::endian::little, false, true}),
    [](const auto& info) { return info.param.name; });

struct VtkRefusal {
  const char* what;
  std::string bytes;
  const char* message;
};
void PrintTo(const VtkRefusal& refusal, std::ostream* out) { *out << refusal.what; }

class VtkRefusals : public ::testing::TestWithParam<VtkRefusal> {};

TEST_P(VtkRefusals, NameWhatIsWrong) {
  const auto mesh = ParseMesh(GetParam().bytes, "a.vtk");
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << mesh.status();
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr(GetParam().message));
}

std::string Legacy(const std::string& rest) {
  return "# vtk DataFile Version 4.2\nx\nASCII\n" + rest;
}

// The text layout of the box, with a part replaced.
std::string DamagedVtp(const std::string& part, const std::string& by,
                       VtpLayout layout = {"", Stored::kText}) {
  VtpWriter writer(layout);
  const std::string text = writer.File(VtpPiece(writer, VtkBox()));
  EXPECT_THAT(text, HasSubstr(part));
  return absl::StrReplaceAll(text, {{part, by}});
}

// Two bytes that claim to be zlib blocks of so many bytes.
std::string VtpBomb(uint32_t blocks, uint32_t size) {
  std::vector<uint32_t> header = {blocks, size, 0};
  header.insert(header.end(), blocks, 2);
  const std::string bytes = absl::Base64Escape(testing::BytesOf(header)) +
                            absl::Base64Escape(std::string(2 * blocks, 'x'));
  return "<VTKFile type='PolyData' compressor='vtkZLibDataCompressor'><PolyData><Piece "
         "NumberOfPoints='1'><Points><DataArray type='Float32' format='binary'>" +
         bytes + "</DataArray></Points></Piece></PolyData></VTKFile>";
}

INSTANTIATE_TEST_SUITE_P(
    All, VtkRefusals,
    ::testing::Values(
        VtkRefusal{"Image", Legacy("DATASET STRUCTURED_POINTS\n"), "found 'STRUCTURED_POINTS'"},
        VtkRefusal{"Encoding", "# vtk DataFile Version 4.2\nx\nUTF\n", "ASCII or BINARY"},
        VtkRefusal{"HeaderAlone", "# vtk DataFile Version 4.2", "found ''"},
        VtkRefusal{"NoMark", "hello", "must begin with '# vtk DataFile Version'"},
        VtkRefusal{"UnknownSection", Legacy("DATASET POLYDATA\nCUBES 3\n"), "found 'CUBES'"},
        VtkRefusal{"UnknownType", Legacy("DATASET POLYDATA\nPOINTS 1 quad\n0 0 0\n"), "'quad'"},
        VtkRefusal{"TooManyPoints", Legacy("DATASET POLYDATA\nPOINTS 2000000000 float\n0 0 0\n"),
                   "declares 6000000000 numbers"},
        VtkRefusal{"OverflowingPoints",
                   Legacy("DATASET POLYDATA\nPOINTS 9223372036854775807 float\n0 0 0\n"),
                   "9223372036854775807"},
        VtkRefusal{"NotANumber", Legacy("DATASET POLYDATA\nPOINTS 1 float\n0 x 0\n"), "line 6"},
        VtkRefusal{"LinesAlone",
                   Legacy("DATASET POLYDATA\nPOINTS 2 float\n0 0 0 1 1 1\nLINES 1 3\n2 0 1\n"),
                   "no polygons or triangle strips (2 points, 1 lines"},
        VtkRefusal{"CornerOutOfRange",
                   Legacy("DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n3 0 0 1\n"),
                   "names point 1 (counted from 0) of 1"},
        VtkRefusal{"CellTooLong",
                   Legacy("DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 1 4\n9 0 0 0\n"),
                   "has 9 corners; 3 of 4"},
        VtkRefusal{"TooManyCells",
                   Legacy("DATASET POLYDATA\nPOINTS 1 float\n0 0 0\nPOLYGONS 99999999999 4\n3 0 0 "
                          "0\n"),
                   "VTK cell 1 of 99999999999"},
        VtkRefusal{"OffsetsGoBack",
                   "# vtk DataFile Version 5.1\nx\nASCII\nDATASET POLYDATA\nPOINTS 1 float\n0 0 "
                   "0\nPOLYGONS 3 3\nOFFSETS vtktypeint64\n0 3 2\nCONNECTIVITY vtktypeint64\n0 0 "
                   "0\n",
                   "offset 2 is 2"},
        VtkRefusal{"VtpOfAnImage", "<VTKFile type='ImageData'/>", "type 'ImageData'"},
        VtkRefusal{"VtpLz4", DamagedVtp("byte_order", "compressor='vtkLZ4DataCompressor' b"),
                   "compressor 'vtkLZ4DataCompressor' is not read"},
        VtkRefusal{"VtpByteOrder", DamagedVtp("LittleEndian", "Middle"), "'Middle'"},
        VtkRefusal{"VtpHeaderType", DamagedVtp("UInt32", "UInt8"), "header_type 'UInt8'"},
        VtkRefusal{"VtpNoCount", DamagedVtp("NumberOfPoints='8'", ""), "NumberOfPoints"},
        VtkRefusal{"VtpWrongCount", DamagedVtp("NumberOfPoints='8'", "NumberOfPoints='9'"),
                   "NumberOfPoints is 9, but <Points> has 24 values"},
        VtkRefusal{"VtpStringPoints", DamagedVtp("Float64", "String"), "'String' is no type"},
        VtkRefusal{"VtpNoOffsets", DamagedVtp("offsets", "set"), "'connectivity' and 'offsets'"},
        VtkRefusal{"VtpOffset",
                   DamagedVtp("'Points' format='appended' offset='",
                              "'Points' format='appended' offset='99999", {"", Stored::kRaw}),
                   "begins at byte"},
        VtkRefusal{"VtpBase64",
                   DamagedVtp("offsets' format='binary'>\n  ", "offsets' format='binary'>\n  !",
                              {"", Stored::kInline}),
                   "is not base64"},
        VtkRefusal{"VtpLinesAlone", DamagedVtp("Polys", "Lines"),
                   "no polygons or triangle strips (8 points, 12 lines"},
        VtkRefusal{"VtpNotClosed", "<VTKFile type='PolyData'>", "not well-formed XML"},
        VtkRefusal{"VtpNoRoot", "<VTKFiles/>", "no element <VTKFile>"},
        VtkRefusal{"VtpBomb", VtpBomb(1, 2'000'000'000), "so many are not possible"},
        VtkRefusal{"VtpDamagedZlib", VtpBomb(1, 100), "zlib data of 2 bytes"}),
    [](const auto& info) { return info.param.what; });

TEST(VtpReader, RefusesArraysThatOverlap) {
  VtpWriter writer({"", Stored::kRaw});
  std::string piece = VtpPiece(writer, VtkBox());
  std::string pieces;
  for (int n = 0; n < 10; ++n) pieces += piece;
  EXPECT_THAT(std::string(ParseMesh(writer.File(pieces), "a.vtp").status().message()),
              HasSubstr("overlap in <AppendedData>"));
}

TEST(VtpReader, LimitsWhatArraysExpandTo) {
  VtpWriter writer({"", Stored::kRaw, std::endian::little, false, true});
  const std::string bytes = writer.File(VtpPiece(writer, VtkBox()));
  EXPECT_EQ(ParseMesh(bytes, "a.vtp", {.max_file_bytes = 100}).status().code(),
            absl::StatusCode::kResourceExhausted);
}

TEST(VtpReader, SurvivesDeepAndManyElements) {
  std::string deep = "<VTKFile type='PolyData'>";
  for (int n = 0; n < 200'000; ++n) deep += "<a>";
  EXPECT_FALSE(ParseMesh(deep, "a.vtp").ok());
  std::string many = "<VTKFile type='PolyData'>";
  for (int n = 0; n < 3'000'000; ++n) many += "<a/>";
  EXPECT_EQ(ParseMesh(many, "a.vtp").status().code(), absl::StatusCode::kResourceExhausted);
}

}  // namespace
}  // namespace bccskel
