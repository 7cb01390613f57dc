#include "server/durable/folder_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

using std::chrono::hours;
using testing::HasSubstr, testing::SizeIs;

class FolderFilesTest : public testing::Test {
 protected:
  FolderFilesTest() {
    options_.data_directory = folder_.path();
    options_.now = [this] { return std::chrono::system_clock::now() + later_; };
    options_.on_warning = [this](const std::string& warning) { warnings_.push_back(warning); };
    Begin("jobs.db");
  }
  // As a new process does, with this job store.
  void Begin(const std::string& tables) {
    files_.reset();
    auto lock = FolderLock::Take(folder_.path());
    ASSERT_TRUE(lock.ok()) << lock.status();
    files_ = std::make_unique<FolderFiles>(options_, *std::move(lock));
    auto store = OpenSqliteJobStore(folder_ / tables);
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
  }
  std::string Write(const std::string& path) const {
    std::filesystem::create_directories(std::filesystem::path(path).parent_path());
    std::ofstream(path) << "bytes";
    return path;
  }
  std::string Unknown(const std::string& name) const {
    return Write(blobs_.PathOfBlob("clinic", name));
  }
  // A blob whose volume the tables have.
  std::string Known(const std::string& digest, bool there = true) const {
    VolumeRow row;
    row.tenant = "clinic";
    row.name = "volumes/" + digest;
    row.blob_digest = digest;
    EXPECT_TRUE(store_->Begin().ok());
    EXPECT_TRUE(store_->Put(row).ok());
    EXPECT_TRUE(store_->Commit().ok());
    const std::string path = blobs_.PathOfBlob("clinic", digest);
    return there ? Write(path) : path;
  }
  static bool IsThere(const std::string& path) { return std::filesystem::exists(path); }

  const test::TemporaryFolder folder_;
  const BlobStore blobs_{folder_.path()};
  hours later_{0};
  std::vector<std::string> warnings_;
  DurableOptions options_;
  std::unique_ptr<FolderFiles> files_;
  std::unique_ptr<JobStore> store_;
};

TEST_F(FolderFilesTest, WhatIsUnknownStaysForADay) {
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  const std::string known = Known("a"), unknown = Unknown("b");
  const std::string unconfirmed = Unknown(std::string("c") + kUnconfirmed);
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  EXPECT_TRUE(IsThere(unknown));
  EXPECT_FALSE(IsThere(unconfirmed)) << "of that nothing was confirmed";
  ASSERT_THAT(warnings_, SizeIs(1));
  EXPECT_THAT(warnings_[0], HasSubstr("1 files below"));
  later_ = hours(25);
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  EXPECT_FALSE(IsThere(unknown));
  EXPECT_TRUE(IsThere(known));
}

TEST_F(FolderFilesTest, NothingUnknownGoesWhileSomethingIsMissed) {
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  const std::string unknown = Unknown("b");
  Known("a", false);
  later_ = hours(25);
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  EXPECT_TRUE(IsThere(unknown)) << "it may be the one that is missed";
  ASSERT_THAT(warnings_, SizeIs(1));
  EXPECT_THAT(warnings_[0], HasSubstr("files that are named are missing"));
}

TEST_F(FolderFilesTest, AnotherJobStoreIsRefusedUnlessItAdopts) {
  const std::string known = Known("a");
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  Begin("other.db");
  const absl::Status refused = files_->TakeOver(*store_);
  EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refused.message()), HasSubstr("--unknown-data adopt"));
  EXPECT_EQ(files_->Join(*store_).code(), absl::StatusCode::kFailedPrecondition);
  options_.unknown_data = "adopt";
  EXPECT_TRUE(files_->TakeOver(*store_).ok());
  EXPECT_TRUE(files_->Join(*store_).ok()) << "it is this one's now";
  EXPECT_TRUE(IsThere(known));
}

TEST_F(FolderFilesTest, ADamagedLockIsRepairedByTheStoreThatKnowsAllFiles) {
  Known("a");
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  std::fstream(folder_ / "lock", std::ios::in | std::ios::out) << "x";
  Begin("jobs.db");
  ASSERT_TRUE(files_->TakeOver(*store_).ok());
  ASSERT_THAT(warnings_, SizeIs(1));
  EXPECT_THAT(warnings_[0], HasSubstr("lock was damaged"));
  Begin("jobs.db");
  EXPECT_TRUE(files_->Join(*store_).ok());
}

TEST_F(FolderFilesTest, AFolderOfAnOlderServerBelongsToWhoKnowsAFile) {
  Unknown("b");
  EXPECT_EQ(files_->TakeOver(*store_).code(), absl::StatusCode::kFailedPrecondition);
  Known("a");
  EXPECT_TRUE(files_->TakeOver(*store_).ok());
}

TEST_F(FolderFilesTest, MissingTablesAreRefusedOnlyBesideFiles) {
  const std::string missing = folder_ / "missing.db";
  EXPECT_TRUE(FolderFiles::CheckTables(missing, options_).ok());
  Unknown("b");
  EXPECT_EQ(FolderFiles::CheckTables(missing, options_).code(),
            absl::StatusCode::kFailedPrecondition);
  std::ofstream(missing).flush();
  EXPECT_EQ(FolderFiles::CheckTables(missing, options_).code(),
            absl::StatusCode::kFailedPrecondition)
      << "empty ones are as none";
  options_.unknown_data = "adopt";
  EXPECT_TRUE(FolderFiles::CheckTables(missing, options_).ok());
}

TEST_F(FolderFilesTest, SweepsWhatWasOldAndIsStillUnknown) {
  const std::string old = Unknown("b"), known_since = Unknown("a");
  later_ = hours(25);
  const auto found = files_->OldFiles();
  EXPECT_EQ(found.size(), 2u);
  Known("a");
  ASSERT_TRUE(files_->Sweep(*store_, found).ok());
  EXPECT_FALSE(IsThere(old));
  EXPECT_TRUE(IsThere(known_since));
}

TEST_F(FolderFilesTest, RemovesWhatACrashLeftOfADeletionUnlessItIsWantedAgain) {
  const std::string gone = Unknown("b"), wanted = Known("a");
  ASSERT_TRUE(store_->Begin().ok());
  for (const char* digest : {"a", "b"}) {
    ASSERT_TRUE(store_->Put(RemovalRow{RemovalRow::Kind::kBlob, "clinic", digest}).ok());
  }
  ASSERT_TRUE(files_->RemoveDeleted(*store_).ok());
  ASSERT_TRUE(store_->Commit().ok());
  EXPECT_FALSE(IsThere(gone));
  EXPECT_TRUE(IsThere(wanted));
  EXPECT_THAT(*store_->All<RemovalRow>(), SizeIs(0));
}

}  // namespace
}  // namespace bccskel::server
