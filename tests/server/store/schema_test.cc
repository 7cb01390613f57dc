#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "server/store/file_io.h"
#include "server/store/job_store.h"
#include "server/store/sql_database.h"
#include "tests/server/store/temporary_folder.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr;

TEST(SchemaTest, RefusesAFileOfANewerServer) {
  const TemporaryFolder folder;
  {
    auto database = *OpenSqlite(folder / "jobs.db");
    ASSERT_TRUE(database->Execute("PRAGMA user_version = 999").ok());
  }
  const auto store = OpenSqliteJobStore(folder / "jobs.db");
  EXPECT_EQ(store.status().code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_THAT(std::string(store.status().message()), HasSubstr("999"));
}

TEST(SchemaTest, RefusesADamagedFile) {
  const TemporaryFolder folder;
  {
    auto file = *File::OpenToWrite(folder / "jobs.db");
    ASSERT_TRUE(file.WriteAt(0, std::string(8192, 'x')).ok());
  }
  EXPECT_EQ(OpenSqliteJobStore(folder / "jobs.db").status().code(), absl::StatusCode::kDataLoss);
}

// The tables of version 1 as they were, with a job and a volume.
constexpr char kVersion1[] = R"(
CREATE TABLE uploads(tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL,
  size_bytes INTEGER NOT NULL, job TEXT NOT NULL, volume TEXT NOT NULL, used INTEGER NOT NULL,
  PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE TABLE volumes(tenant TEXT NOT NULL, name TEXT NOT NULL, declaration BLOB NOT NULL,
  blob_digest TEXT NOT NULL, volume_digest TEXT NOT NULL, size_bytes INTEGER NOT NULL,
  created INTEGER NOT NULL, used INTEGER NOT NULL, PRIMARY KEY(tenant, name)) WITHOUT ROWID;
CREATE INDEX volumes_by_blob ON volumes(tenant, blob_digest);
CREATE INDEX volumes_by_volume ON volumes(tenant, volume_digest);
CREATE TABLE results(number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL,
  key TEXT NOT NULL, file TEXT NOT NULL, file_digest TEXT NOT NULL, bytes INTEGER NOT NULL,
  records INTEGER NOT NULL, summary BLOB NOT NULL, UNIQUE(tenant, key));
CREATE TABLE jobs(number INTEGER PRIMARY KEY AUTOINCREMENT, tenant TEXT NOT NULL,
  name TEXT NOT NULL, request_id TEXT NOT NULL, body BLOB NOT NULL, upload TEXT NOT NULL,
  options BLOB NOT NULL, priority INTEGER NOT NULL, created INTEGER NOT NULL, volume TEXT NOT NULL,
  state INTEGER NOT NULL, attempts INTEGER NOT NULL, crashes INTEGER NOT NULL,
  sequence INTEGER NOT NULL, owner TEXT NOT NULL, error BLOB NOT NULL, result INTEGER NOT NULL,
  started INTEGER NOT NULL, ended INTEGER NOT NULL, UNIQUE(tenant, name));
CREATE UNIQUE INDEX jobs_by_request ON jobs(tenant, request_id) WHERE request_id != '';
CREATE INDEX jobs_by_tenant ON jobs(tenant, number);
CREATE INDEX jobs_unfinished ON jobs(number) WHERE state < 3;
CREATE INDEX jobs_by_result ON jobs(result) WHERE result != 0;
CREATE TABLE events(job INTEGER NOT NULL REFERENCES jobs(number) ON DELETE CASCADE,
  sequence INTEGER NOT NULL, time INTEGER NOT NULL, state INTEGER NOT NULL,
  attempt INTEGER NOT NULL, error BLOB NOT NULL, PRIMARY KEY(job, sequence)) WITHOUT ROWID;
INSERT INTO volumes VALUES('clinic', 'volumes/1', x'01', 'ab', '', 7, 1000000, 2000000);
INSERT INTO jobs VALUES(5, 'clinic', 'jobs/old', 'request', x'02', '', x'03', 1, 3000000,
  'volumes/1', 1, 0, 0, 1, '', x'', 0, 0, 0);
INSERT INTO events VALUES(5, 1, 3000000, 1, 0, x'');
PRAGMA user_version = 1;
)";

TEST(SchemaTest, TakesOverAFileOfVersion1) {
  const TemporaryFolder folder;
  ASSERT_TRUE((*OpenSqlite(folder / "jobs.db"))->Execute(kVersion1).ok());
  const auto store = OpenSqliteJobStore(folder / "jobs.db");
  ASSERT_TRUE(store.ok()) << store.status();
  const JobRow job = **(*store)->Find<JobRow>("clinic", "jobs/old");
  EXPECT_EQ(job.number, 5);
  EXPECT_EQ(job.state, JobState::kQueued);
  EXPECT_EQ(job.options, "\x03");
  EXPECT_EQ(job.threads, 0);
  EXPECT_EQ(job.trace, "");
  EXPECT_EQ(job.created, Time(std::chrono::seconds(3)));
  EXPECT_THAT(*(*store)->EventsAfter(5, 0), testing::SizeIs(1));
  EXPECT_EQ((*(*store)->Find<VolumeRow>("clinic", "volumes/1"))->size_bytes, 7u);
  JobRow next;
  next.tenant = "clinic";
  next.name = "jobs/new";
  next.threads = 2;
  EXPECT_EQ(*(*store)->InsertJob(next), 6) << "numbers go on growing";
  EXPECT_EQ((*(*store)->Find<JobRow>("clinic", "jobs/new"))->threads, 2);
  EXPECT_THAT(*(*store)->ListJobs("clinic", std::nullopt, ~0u, 10), testing::SizeIs(2));
}

TEST(SchemaTest, StatesTheVersionThatItWrites) {
  const TemporaryFolder folder;
  ASSERT_TRUE(OpenSqliteJobStore(folder / "jobs.db").ok());
  auto database = *OpenSqlite(folder / "jobs.db");
  EXPECT_EQ((*database->Run("PRAGMA user_version", {})).front().Number(), SqliteSchemaVersion());
}

}  // namespace
}  // namespace bccskel::server
