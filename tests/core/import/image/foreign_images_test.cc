// Images written by programs of others, at the time of the test, are read as what they were made
// from.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "tests/core/import/image/image_bytes.h"
#include "tests/support/temporary_folder.h"

namespace bccskel {
namespace {

constexpr ImageSize kSize = {7, 5, 4};

// A line of the list that foreign_images.py writes.
struct Expected {
  std::string name, type, values;
  std::array<double, 12> placement = {};  // the steps of the three axes, the origin
};

std::vector<Expected> ReadList(const std::filesystem::path& folder) {
  std::vector<Expected> list;
  std::ifstream file(folder / "list.txt");
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    Expected& expected = list.emplace_back();
    words >> expected.name >> expected.type >> expected.values;
    for (double& number : expected.placement) words >> number;
    EXPECT_TRUE(words) << line;
  }
  return list;
}

double ValueAt(const std::string& values, int x, int y, int z) {
  if (values == "bool") return (x + y + z) % 2;
  return (7 * x + 13 * y + 29 * z) % 100 + (values == "quarter" ? 0.25 : 0);
}

void ExpectPlacement(const Placement& placement, const std::array<double, 12>& expected) {
  const WorldPoint origin = placement.ToWorld(0, 0, 0);
  for (size_t axis = 0; axis < 3; ++axis) {
    const WorldPoint next =
        placement.ToWorld(axis == 0 ? 2 : 0, axis == 1 ? 2 : 0, axis == 2 ? 2 : 0);
    EXPECT_NEAR(origin[axis], expected[9 + axis], 1e-5);
    for (size_t n = 0; n < 3; ++n) {
      EXPECT_NEAR(next[n] - origin[n], expected[3 * axis + n], 1e-5) << "axis " << axis;
    }
  }
}

void ExpectImage(const testing::ReadImage& image, const Expected& expected) {
  EXPECT_EQ(VoxelTypeName(image.info.type), expected.type);
  ASSERT_EQ(image.info.size, kSize);
  ExpectPlacement(image.info.placement, expected.placement);
  size_t n = 0;
  for (int z = 0; z < kSize.nz; ++z) {
    for (int y = 0; y < kSize.ny; ++y) {
      for (int x = 0; x < kSize.nx; ++x, ++n) {
        ASSERT_EQ(image.values[n], ValueAt(expected.values, x, y, z))
            << "(" << x << ", " << y << ", " << z << ")";
      }
    }
  }
}

class ForeignImages : public ::testing::TestWithParam<const char*> {};

TEST_P(ForeignImages, AreReadAsTheyWereMade) {
  const test::TemporaryFolder folder;
  const std::string command = std::string(BCCSKEL_PYTHON) + " -B " + BCCSKEL_FOREIGN_IMAGES + " " +
                              GetParam() + " " + folder.path();
  const int status = std::system(command.c_str());
  if (WIFEXITED(status) && WEXITSTATUS(status) == 77) GTEST_SKIP() << GetParam() << " is missing";
  ASSERT_EQ(status, 0) << command;
  const std::vector<Expected> list = ReadList(folder.path());
  ASSERT_GE(list.size(), 10U);
  for (const Expected& expected : list) {
    SCOPED_TRACE(expected.name);
    const auto image = MustRead(testing::ReadAll(OpenImage(folder / expected.name)));
    ExpectImage(image, expected);
  }
}

INSTANTIATE_TEST_SUITE_P(Programs, ForeignImages,
                         ::testing::Values("numpy", "nibabel", "tifffile", "vtk", "teem", "zarr"),
                         [](const auto& info) { return std::string(info.param); });

}  // namespace
}  // namespace bccskel
