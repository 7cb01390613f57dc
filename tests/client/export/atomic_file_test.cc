#include "client/export/atomic_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <csignal>
#include <filesystem>
#include <string>

#include "tests/support/temporary_folder.h"

namespace bccskel::exporting {
namespace {

namespace fs = std::filesystem;

// Files may grow to no more than a size; a write beyond fails as on a full disk.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : before_signal_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit = {bytes, before_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, before_signal_);
  }

 private:
  rlimit before_;
  void (*before_signal_)(int);
};

class AtomicFileTest : public testing::Test {
 protected:
  const test::TemporaryFolder folder_;
};

TEST_F(AtomicFileTest, WritesAllBytesAndLeavesNothingElse) {
  const std::string bytes("a\0b\n", 4);
  ASSERT_TRUE(WriteFileAtomically(folder_ / "new", bytes).ok());
  EXPECT_EQ(test::BytesOfFile(folder_ / "new"), bytes);
  EXPECT_EQ(folder_.Count(), 1);
}

TEST_F(AtomicFileTest, ReplacesAFile) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "old and long").ok());
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "new").ok());
  EXPECT_EQ(test::BytesOfFile(folder_ / "file"), "new");
}

TEST_F(AtomicFileTest, AFolderThatIsNotThereIsNamed) {
  const std::string folder = folder_ / "a/b", path = folder + "/c.swc";
  EXPECT_EQ(CheckWritable(path).message(),
            "cannot write " + path + ": the folder " + folder + " does not exist; create it first");
  EXPECT_TRUE(absl::IsNotFound(WriteFileAtomically(path, "bytes")));
}

TEST_F(AtomicFileTest, ANameMayBeAsLongAsTheFileSystemAllows) {
  const std::string path = folder_ / (std::string(251, 'a') + ".swc");
  EXPECT_TRUE(CheckWritable(path).ok()) << CheckWritable(path);
  EXPECT_TRUE(WriteFileAtomically(path, "bytes").ok());
  EXPECT_EQ(test::BytesOfFile(path), "bytes");
  EXPECT_EQ(folder_.Count(), 1);
}

TEST_F(AtomicFileTest, ANameThatIsTooLongIsRefusedBeforehand) {
  EXPECT_FALSE(CheckWritable(folder_ / std::string(256, 'a')).ok());
  EXPECT_EQ(folder_.Count(), 0);
}

TEST_F(AtomicFileTest, ALinkStaysALink) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "old").ok());
  fs::create_symlink("file", folder_ / "link");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "link", "new").ok());
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(test::BytesOfFile(folder_ / "file"), "new");
}

TEST_F(AtomicFileTest, AFailureLeavesTheOldFileAndNoDraft) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "old").ok());
  const FileSizeLimit limit(1000);
  const absl::Status status = WriteFileAtomically(folder_ / "file", std::string(5000, 'x'));
  EXPECT_FALSE(status.ok());
  EXPECT_EQ(test::BytesOfFile(folder_ / "file"), "old");
  EXPECT_EQ(folder_.Count(), 1);
}

TEST_F(AtomicFileTest, NamesThePathThatCannotBeWritten) {
  const std::string path = folder_ / "no/such/folder";
  const absl::Status status = WriteFileAtomically(path, "bytes");
  EXPECT_TRUE(absl::IsNotFound(status)) << status;
  EXPECT_NE(status.message().find(path), status.message().npos) << status;
}

TEST_F(AtomicFileTest, AStopLeavesTheOldFileAndNoDraft) {
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "old").ok());
  std::stop_source stop;
  stop.request_stop();
  const absl::Status status = WriteFileAtomically(folder_ / "file", "new", stop.get_token());
  EXPECT_TRUE(absl::IsCancelled(status)) << status;
  EXPECT_EQ(test::BytesOfFile(folder_ / "file"), "old");
  EXPECT_EQ(folder_.Count(), 1);
}

TEST_F(AtomicFileTest, TellsBeforehandWhetherAFileCanBeWritten) {
  EXPECT_TRUE(CheckWritable(folder_ / "new").ok());
  EXPECT_TRUE(CheckWritable("/dev/null").ok());
  EXPECT_EQ(folder_.Count(), 0);
  const std::string path = folder_ / "no/folder";
  const absl::Status missing = CheckWritable(path);
  EXPECT_TRUE(absl::IsNotFound(missing)) << missing;
  EXPECT_NE(missing.message().find(path), missing.message().npos) << missing;
  EXPECT_FALSE(CheckWritable(folder_.path()).ok());
  ASSERT_TRUE(WriteFileAtomically(folder_ / "file", "bytes").ok());
  EXPECT_TRUE(CheckWritable(folder_ / "file").ok());
  EXPECT_FALSE(CheckWritable(folder_ / "file/below").ok());
}

TEST_F(AtomicFileTest, ALinkToNothingStaysAndItsTargetIsMade) {
  fs::create_directory(folder_ / "data");
  fs::create_symlink("data/new", folder_ / "link");
  fs::create_symlink(folder_ / "link", folder_ / "link to link");
  ASSERT_TRUE(WriteFileAtomically(folder_ / "link to link", "bytes").ok());
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(test::BytesOfFile(folder_ / "data/new"), "bytes");
  fs::create_symlink(folder_ / "none/new", folder_ / "astray");
  const absl::Status astray = WriteFileAtomically(folder_ / "astray", "bytes");
  const std::string none = folder_ / "none";
  EXPECT_NE(astray.message().find(none + " does not exist"), astray.message().npos) << astray;
}

TEST_F(AtomicFileTest, AStopEndsTheWaitForTheReaderOfAPipe) {
  const std::string pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  std::stop_source stop;
  stop.request_stop();
  const absl::Status status = WriteFileAtomically(pipe, "bytes", stop.get_token());
  EXPECT_TRUE(absl::IsCancelled(status)) << status;
}

TEST_F(AtomicFileTest, AFolderIsNotReplaced) {
  EXPECT_FALSE(WriteFileAtomically(folder_.path(), "bytes").ok());
  EXPECT_TRUE(fs::is_directory(folder_.path()));
}

TEST_F(AtomicFileTest, WritesToADeviceWithoutReplacingIt) {
  EXPECT_TRUE(WriteFileAtomically("/dev/null", "bytes").ok());
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
  EXPECT_FALSE(WriteFileAtomically("/dev/full", "bytes").ok());
}

}  // namespace
}  // namespace bccskel::exporting
