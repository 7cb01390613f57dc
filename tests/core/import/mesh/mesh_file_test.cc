#include "core/import/mesh/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/support/deflated.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

using ::testing::HasSubstr;

// Coordinates that no float holds.
TriangleMesh DoubleBox() { return testing::Box({0.1, 0.2, 0.3}, {1e9 + 0.1, 1.7, 2.3e-5}); }

std::string Gzipped(const std::string& bytes) {
  return testing::Deflated(bytes, testing::Wrapping::kGzip);
}

struct Format {
  const char* name;
  std::string (*write)(const TriangleMesh&);
};
std::string ToAsciiPly(const TriangleMesh& m) { return ToPly(m, testing::PlyKind::kAscii); }
std::string ToLittlePly(const TriangleMesh& m) { return ToPly(m, testing::PlyKind::kLittleEndian); }
std::string ToBigPly(const TriangleMesh& m) { return ToPly(m, testing::PlyKind::kBigEndian); }
void PrintTo(const Format& format, std::ostream* out) { *out << format.name; }

class DoubleFormatRoundTrip : public ::testing::TestWithParam<Format> {};

TEST_P(DoubleFormatRoundTrip, KeepsEveryBitOfTheCoordinates) {
  const auto mesh = ParseMesh(GetParam().write(DoubleBox()), "unknown");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(testing::Unshared(*mesh), testing::Unshared(DoubleBox()));
}

TEST_P(DoubleFormatRoundTrip, IsReadFromAGzipFileOfAnyName) {
  const test::TemporaryFolder folder;
  const auto mesh =
      ReadMeshFile(folder.Write("compressed.bin", Gzipped(GetParam().write(DoubleBox()))));
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(testing::Unshared(*mesh), testing::Unshared(DoubleBox()));
}

TEST_P(DoubleFormatRoundTrip, IsRefusedWhenCutAtAnyByteOfItsSecondHalf) {
  const std::string bytes = GetParam().write(testing::Box({0, 0, 0}, {1, 1, 1}));
  for (size_t size = bytes.size() / 2; size + 6 < bytes.size(); ++size) {
    const auto mesh = ParseMesh(bytes.substr(0, size), "cut");
    // OBJ has no counts: a cut one is just smaller.
    const bool shorter = mesh.ok() && mesh->triangles.size() < 12;
    EXPECT_TRUE(shorter || mesh.status().code() == absl::StatusCode::kInvalidArgument)
        << size << " " << mesh.status();
  }
}

INSTANTIATE_TEST_SUITE_P(
    All, DoubleFormatRoundTrip,
    ::testing::Values(Format{"off", testing::ToOff}, Format{"obj", testing::ToObj},
                      Format{"stl", testing::ToAsciiStl}, Format{"ascii_ply", ToAsciiPly},
                      Format{"little_ply", ToLittlePly}, Format{"big_ply", ToBigPly}),
    [](const auto& info) { return info.param.name; });

TEST(MeshFileRoundTrip, BinaryStlGivesTheFloatsOfTheFile) {
  const TriangleMesh box = testing::Box({0.5, 0.25, -1}, {1, 2, 3});
  const auto mesh = ParseMesh(testing::ToBinaryStl(box), "box.stl");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, testing::Unshared(box));
}

TEST(MeshFile, ReadsObjWithContinuedLinesRelativeAndSlashedIndices) {
  const auto mesh = ParseMesh(
      "# c\r\nv 0 0 0 1\r\nv 1 0 0\r\nv 1 1 0\r\nv 0 +1 0\r\nvn 0 0 1\r\n"
      "f -4//1 2/5 \\\r\n 3/5/1 \\\r\n4\r\n",
      "a.obj");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices.size(), 4u);
  EXPECT_THAT(mesh->triangles, ::testing::ElementsAre(TriangleMesh::Triangle{0, 1, 2},
                                                      TriangleMesh::Triangle{0, 2, 3}));
}

TEST(MeshFile, SkipsAByteOrderMark) {
  const std::string mark = "\xEF\xBB\xBF";
  const auto obj = ParseMesh(mark + "v 1 2 3\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", "a.obj");
  ASSERT_TRUE(obj.ok()) << obj.status();
  ASSERT_EQ(obj->vertices.size(), 3u);
  EXPECT_EQ(obj->vertices[0], (std::array<double, 3>{1, 2, 3}));
  const auto off = ParseMesh(mark + "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n", "a.off");
  ASSERT_TRUE(off.ok()) << off.status();
  EXPECT_EQ(off->triangles.size(), 1u);
}

TEST(MeshFile, ReadsOffWithCountsOnTheFirstLineCommentsAndColors) {
  const auto mesh = ParseMesh(
      "# x\nSTCOFF 3 1 0 # counts\n\n0 0 0 9 9 9\n1 0 0 9\n#\n0 1 0\n3 0 1 2 9 9 9\n", "a.off");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices[2], (TriangleMesh::Vertex{0, 1, 0}));
  EXPECT_EQ(mesh->triangles[0], (TriangleMesh::Triangle{0, 1, 2}));
}

TEST(MeshFile, StepsOverUnknownElementsAndListsOfPly) {
  const auto mesh = ParseMesh(
      "ply\r\nformat ascii 1.0\r\nelement thing 2\r\nproperty list uchar float a\r\n"
      "element vertex 3\r\nproperty float z\r\nproperty float q\r\nproperty float x\r\nproperty "
      "float y\r\nelement face 1\r\nproperty uchar f\r\nproperty list int uint vertex_index\r\n"
      "element edge 1\r\nproperty int v\r\nend_header\r\n"
      "2 5 5\r\n0\r\n3 0 1 2\r\n6 0 4 5\r\n9 0 7 8\r\n7 3 2 1 0\r\n1\r\n",
      "a.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->vertices[0], (TriangleMesh::Vertex{1, 2, 3}));
  EXPECT_EQ(mesh->triangles[0], (TriangleMesh::Triangle{2, 1, 0}));
}

TEST(MeshFile, StepsOverTheRemarkThatBlenderWroteIntoPly) {
  const auto mesh = ParseMesh(
      "ply\nformat ascii 1.0\nCreated by Blender3D 247 - www.blender.org, source file: \n"
      "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar uint vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n",
      "a.ply");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->triangles[0], (TriangleMesh::Triangle{0, 1, 2}));
}

TEST(MeshFile, ReadsABinaryStlWhoseHeaderSaysSolid) {
  std::string bytes = testing::ToBinaryStl(testing::Box({0, 0, 0}, {1, 1, 1}));
  bytes.replace(0, 6, "solid ");
  const auto mesh = ParseMesh(bytes, "a.stl");
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(mesh->triangles.size(), 12u);
}

struct Refusal {
  const char* what;
  const char* name;
  std::string bytes;
  const char* message;
};
void PrintTo(const Refusal& refusal, std::ostream* out) { *out << refusal.what; }

class MeshFileRefusal : public ::testing::TestWithParam<Refusal> {};

TEST_P(MeshFileRefusal, NamesWhatIsWrong) {
  const auto mesh = ParseMesh(GetParam().bytes, GetParam().name);
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kInvalidArgument) << mesh.status();
  EXPECT_THAT(std::string(mesh.status().message()), HasSubstr(GetParam().message));
}

INSTANTIATE_TEST_SUITE_P(
    All, MeshFileRefusal,
    ::testing::Values(
        Refusal{"Empty", "a.off", "", "empty"},
        Refusal{"UnknownFormat", "a.nrrd", "NRRD0004\n", "format not supported"},
        Refusal{"PlyWithoutMagic", "a.ply", "noise", "must begin with 'ply'"},
        Refusal{"FourDimensions", "a.off", "4OFF\n1 1 0\n", "three dimensions"},
        Refusal{"BinaryOff", "a.off", "OFF BINARY\n", "binary OFF"},
        Refusal{"NegativeCount", "a.off", "OFF\n-3 1 0\n", "'-3'"},
        Refusal{"HugeCount", "a.off", "OFF\n4000000000 1 0\n0 0 0\n", "4000000000"},
        Refusal{"TooFewVertices", "a.off", "OFF\n3 1 0\n0 0 0\n1 0 0      \n",
                "after 2 of 3 vertices"},
        Refusal{"OverflowingNumber", "a.obj", "v 1e999 0 0\n", "'1e999'"},
        Refusal{"Infinity", "a.obj", "v 0 0 0\nv 0 inf 0\n", "vertex 1"},
        Refusal{"NotANumber", "a.obj", "v 0 zero 0\n", "line 1"},
        Refusal{"IndexPastTheEnd", "a.obj", "v 0 0 0\nf 1 1 2\n", "vertex 1"},
        Refusal{"RelativeIndexBeforeTheFirst", "a.obj", "v 0 0 0\nf 1 1 -2\n", "before the first"},
        Refusal{"WrongStlKeyword", "a.stl", "solid a\nouter shell\n", "'shell'"},
        Refusal{"QuadInStl", "a.stl",
                "solid a\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 0\nvertex 0 1 0\n",
                "expected 'endloop'"},
        Refusal{"PlyFloatListLength", "a.ply",
                "ply\nformat ascii 1.0\nelement face 1\nproperty list float int vertex_index\n"
                "end_header\n",
                "integer type"},
        Refusal{"PlyWithoutFaces", "a.ply",
                "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float "
                "y\nproperty float z\nend_header\n0 0 0\n",
                "'face'"},
        Refusal{"PlyHeaderWithoutEnd", "a.ply", "ply\nformat ascii 1.0\n", "end_header"}),
    [](const auto& info) { return info.param.what; });

TEST(MeshFile, RefusesMoreThanItsLimits) {
  const std::string bytes = testing::ToOff(testing::Box({0, 0, 0}, {1, 1, 1}));
  EXPECT_EQ(ParseMesh(bytes, "a.off", {.max_vertices = 7}).status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_EQ(ParseMesh(bytes, "a.off", {.max_triangles = 11}).status().code(),
            absl::StatusCode::kResourceExhausted);
  EXPECT_TRUE(ParseMesh(bytes, "a.off", {.max_vertices = 8, .max_triangles = 12}).ok());
}

TEST(MeshFile, StopsExpandingGzipAtItsLimit) {
  const std::string bomb = Gzipped(std::string(20'000'000, '#'));
  ASSERT_LT(bomb.size(), 40'000u);
  const test::TemporaryFolder folder;
  const auto mesh = ReadMeshFile(folder.Write("bomb.obj.gz", bomb), {.max_file_bytes = 1'000'000});
  EXPECT_EQ(mesh.status().code(), absl::StatusCode::kResourceExhausted) << mesh.status();
}

TEST(MeshFile, RefusesACutOrDamagedGzipStream) {
  std::string bytes = Gzipped(testing::ToOff(testing::Sphere({0, 0, 0}, 1)));
  const test::TemporaryFolder folder;
  const auto read = [&folder](const std::string& b) {
    return ReadMeshFile(folder.Write("damaged.off.gz", b)).status();
  };
  EXPECT_EQ(read(bytes.substr(0, bytes.size() / 2)).code(), absl::StatusCode::kInvalidArgument);
  EXPECT_EQ(read(bytes.substr(0, bytes.size() - 1)).code(), absl::StatusCode::kInvalidArgument);
  bytes[bytes.size() - 6] = static_cast<char>(~bytes[bytes.size() - 6]);  // its check sum
  EXPECT_EQ(read(bytes).code(), absl::StatusCode::kInvalidArgument);
}

TEST(MeshFile, TellsAMissingFileFromAFolder) {
  EXPECT_EQ(ReadMeshFile("/nowhere/a.off").status().code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(ReadMeshFile(::testing::TempDir()).status().code(), absl::StatusCode::kInvalidArgument);
}

TEST(MeshFile, KnowsItsFileNames) {
  EXPECT_TRUE(IsMeshPath("a/b.c/X.OFF"));
  EXPECT_TRUE(IsMeshPath("x.stl.gz"));
  for (const char* name : {"a.glb", "a.gltf", "a.vtk", "a.vtp", "lh.surf.gii", "a.vtk.gz"}) {
    EXPECT_TRUE(IsMeshPath(name)) << name;
  }
  EXPECT_FALSE(IsMeshPath("x.exr"));
  EXPECT_FALSE(IsMeshPath("dir.obj/x"));
}

}  // namespace
}  // namespace bccskel
