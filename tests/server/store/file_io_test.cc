#include "server/store/file_io.h"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

// A damaged file that names the size of a part must not make the server allocate it.
TEST(File, ReadsWhatIsThereWhateverSizeIsWanted) {
  const test::TemporaryFolder folder;
  absl::StatusOr<File> file = File::OpenToWrite(folder.path() + "/file");
  ASSERT_TRUE(file.ok()) << file.status();
  ASSERT_TRUE(file->WriteAt(0, "0123456789").ok());
  constexpr size_t kMost = std::numeric_limits<uint32_t>::max();
  const absl::StatusOr<std::string> end = file->ReadAt(7, kMost);
  ASSERT_TRUE(end.ok()) << end.status();
  EXPECT_EQ(*end, "789");
  EXPECT_LT(end->capacity(), 1000u);
  EXPECT_EQ(*file->ReadAt(2, 3), "234");
  EXPECT_EQ(*file->ReadAt(10, kMost), "");
  EXPECT_EQ(*file->ReadAt(11, kMost), "");
}

}  // namespace
}  // namespace bccskel::server
