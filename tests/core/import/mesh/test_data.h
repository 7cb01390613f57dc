#ifndef BCCSKEL_TESTS_CORE_IMPORT_MESH_TEST_DATA_H_
#define BCCSKEL_TESTS_CORE_IMPORT_MESH_TEST_DATA_H_

#include <filesystem>
#include <string>

// Where the reference meshes lie; set by CMake from BCCSKEL_TEST_DATA. They are not part of the
// repository, so tests that need them skip when the folder is missing.
#define BCCSKEL_SKIP_WITHOUT_TEST_DATA()                             \
  if (!std::filesystem::is_directory(BCCSKEL_TEST_DATA_DIR "/mesh")) \
  GTEST_SKIP() << "no reference meshes in " BCCSKEL_TEST_DATA_DIR    \
                  ": set the "                                       \
                  "CMake variable BCCSKEL_TEST_DATA"

namespace bccskel::testing {

inline std::string TestData(const std::string& name) { return BCCSKEL_TEST_DATA_DIR "/" + name; }

}  // namespace bccskel::testing

#endif  // BCCSKEL_TESTS_CORE_IMPORT_MESH_TEST_DATA_H_
