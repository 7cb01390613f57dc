#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "server/store/file_io.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr;

// The refusal of a file with that version.
absl::Status RefusalOf(int version) {
  const test::TemporaryFolder folder;
  const std::string state = "PRAGMA user_version = " + std::to_string(version);
  EXPECT_TRUE((*OpenSqlite(folder / "jobs.db"))->Execute(state).ok());
  return OpenSqliteJobStore(folder / "jobs.db").status();
}

TEST(SchemaTest, RefusesAFileOfANewerServer) {
  const absl::Status refusal = RefusalOf(999);
  EXPECT_EQ(refusal.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refusal.message()), HasSubstr("has version 999, this server needs"));
}

TEST(SchemaTest, RefusesAFileOfAnOlderServerAndSaysWhatToDo) {
  const absl::Status refusal = RefusalOf(kSqliteSchemaVersion - 1);
  EXPECT_EQ(refusal.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(refusal.message()),
              HasSubstr("has version 6, this server needs version 7"));
  EXPECT_THAT(std::string(refusal.message()), HasSubstr("start with an empty --data-dir"));
}

TEST(SchemaTest, RefusesADamagedFile) {
  const test::TemporaryFolder folder;
  {
    auto file = *File::OpenToWrite(folder / "jobs.db");
    ASSERT_TRUE(file.WriteAt(0, std::string(8192, 'x')).ok());
  }
  EXPECT_EQ(OpenSqliteJobStore(folder / "jobs.db").status().code(), absl::StatusCode::kDataLoss);
}

TEST(SchemaTest, StatesTheVersionThatItWrites) {
  const test::TemporaryFolder folder;
  ASSERT_TRUE(OpenSqliteJobStore(folder / "jobs.db").ok());
  auto database = *OpenSqlite(folder / "jobs.db");
  EXPECT_EQ((*database->Run("PRAGMA user_version", {})).front().Number(), kSqliteSchemaVersion);
}

TEST(SchemaTest, LeavesTheLogOfACrashedServerToOneThatUsesIt) {
  const test::TemporaryFolder folder;
  const auto store = OpenSqliteJobStore(folder / "jobs.db");
  ASSERT_TRUE(store.ok()) << store.status();
  const std::string crashed = folder / "crashed.db";
  for (const std::string log : {"", "-wal"}) {
    std::filesystem::copy((folder / "jobs.db") + log, crashed + log);
  }
  EXPECT_TRUE(OpenSqlite(crashed).ok());  // as by a server that refuses the version
  EXPECT_FALSE(LacksItsLog(crashed));
  EXPECT_TRUE(OpenSqliteJobStore(crashed).ok());
  EXPECT_FALSE(LacksItsLog(crashed)) << "it was closed in good order";
  EXPECT_FALSE(std::filesystem::exists(crashed + "-wal"));
}

}  // namespace
}  // namespace bccskel::server
