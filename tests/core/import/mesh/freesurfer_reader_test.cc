#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <string>
#include <vector>

#include "core/import/mesh/mesh_file.h"
#include "tests/core/import/mesh/mesh_bytes.h"
#include "tests/core/import/mesh/mesh_shapes.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

using testing::BytesOf;
using ::testing::HasSubstr;

TriangleMesh BoxOfBrain() { return testing::Box({-1, 0.5, 2}, {3, 4, 5}); }

std::string FreeSurferFile(const TriangleMesh& mesh, const std::string& text = "created by us\n\n",
                           std::vector<int32_t> counts = {}) {
  if (counts.empty()) {
    counts = {static_cast<int32_t>(mesh.vertices.size()),
              static_cast<int32_t>(mesh.triangles.size())};
  }
  return "\xff\xff\xfe" + text + BytesOf(counts, std::endian::big) +
         BytesOf(testing::CoordinatesOf<float>(mesh), std::endian::big) +
         BytesOf(testing::CornersOf<int32_t>(mesh), std::endian::big);
}

std::string FreeSurferError(const std::string& bytes) {
  return std::string(ParseMesh(bytes, "lh.white").status().message());
}

TEST(FreeSurferReader, GivesTheSurfaceWhateverItsName) {
  for (const char* const text : {"created by us\n\n", "\n\n", "a\n"}) {
    for (const char* const behind : {"", "\0\0\0\x14 geometry of a volume"}) {
      const auto mesh = ParseMesh(FreeSurferFile(BoxOfBrain(), text) + behind, "lh.pial");
      ASSERT_TRUE(mesh.ok()) << mesh.status();
      EXPECT_EQ(*mesh, BoxOfBrain());
    }
  }
}

TEST(FreeSurferReader, RefusesEveryCut) {
  const std::string bytes = FreeSurferFile(BoxOfBrain());
  for (size_t size = 0; size < bytes.size(); ++size) {
    EXPECT_EQ(ParseMesh(bytes.substr(0, size), "lh.white").status().code(),
              absl::StatusCode::kInvalidArgument)
        << size;
  }
}

TEST(FreeSurferReader, NamesWhatIsWrong) {
  const std::string text = "a\n\n";
  EXPECT_THAT(FreeSurferError(FreeSurferFile(BoxOfBrain(), text, {2147483647, 2147483647})),
              HasSubstr("2147483647 vertices and 2147483647 triangles are declared, of 12 bytes "
                        "each; 240 bytes follow"));
  EXPECT_THAT(FreeSurferError(FreeSurferFile(BoxOfBrain(), text, {-1, 12})),
              HasSubstr("-1 vertices"));
  EXPECT_THAT(FreeSurferError(FreeSurferFile(BoxOfBrain(), text, {8, -1})),
              HasSubstr("-1 triangles"));
  EXPECT_THAT(FreeSurferError(FreeSurferFile(BoxOfBrain(), text, {8, 0})),
              HasSubstr("no triangles (8 vertices)"));
  TriangleMesh wrong = BoxOfBrain();
  wrong.triangles[3][1] = 8;
  EXPECT_THAT(FreeSurferError(FreeSurferFile(wrong)), HasSubstr("triangle 3 names vertex 8"));
  for (const char* const mark : {"\xff\xff\xff", "\xff\xff\xfd"}) {
    EXPECT_THAT(FreeSurferError(mark + FreeSurferFile(BoxOfBrain()).substr(3)),
                HasSubstr("values per vertex (as lh.thickness) or an old surface"));
  }
}

TEST(FreeSurferReader, IsChosenByTheContentOfAPath) {
  const test::TemporaryFolder folder;
  const std::string surface = folder.Write("Lh.white", FreeSurferFile(BoxOfBrain()));
  EXPECT_TRUE(IsMeshPath(surface));
  EXPECT_FALSE(IsMeshPath(folder.Write("Lh.text", "text")));
  EXPECT_FALSE(IsMeshPath(folder.path()));
  const auto mesh = ReadMeshFile(surface);
  ASSERT_TRUE(mesh.ok()) << mesh.status();
  EXPECT_EQ(*mesh, BoxOfBrain());
}

}  // namespace
}  // namespace bccskel
