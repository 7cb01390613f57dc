#include "server/store/job_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <random>
#include <string>
#include <thread>
#include <vector>

#include "server/store/file_io.h"
#include "server/store/schema.h"
#include "server/store/sql_database.h"
#include "tests/server/store/postgres_server.h"
#include "tests/server/store/temporary_folder.h"

namespace bccskel::server {
namespace {

using testing::ElementsAre, testing::Field, testing::HasSubstr, testing::IsEmpty;

enum class Backend { kSqlite, kPostgres };

class JobStoreTest : public testing::TestWithParam<Backend> {
 protected:
  void SetUp() override {
    if (GetParam() == Backend::kPostgres) {
      PostgresServer* const server = PostgresServer::Get();
      if (server == nullptr) GTEST_SKIP() << "PostgreSQL is not installed (or was not built in)";
      database_ = server->NewDatabase();
    }
    Reopen();
  }
  absl::StatusOr<std::unique_ptr<JobStore>> Open() {
    return database_.empty() ? OpenSqliteJobStore(folder_ / "jobs.db")
                             : OpenPostgresJobStore(database_);
  }
  void Reopen() {
    store_.reset();
    auto store = Open();
    ASSERT_TRUE(store.ok()) << store.status();
    store_ = *std::move(store);
  }
  static JobRow Job(const std::string& tenant, const std::string& name) {
    JobRow job;
    job.tenant = tenant;
    job.name = name;
    job.created = Time(std::chrono::seconds(1));
    return job;
  }
  int64_t Insert(const JobRow& job) {
    const auto number = store_->InsertJob(job);
    EXPECT_TRUE(number.ok()) << number.status();
    return *number;
  }

  TemporaryFolder folder_;
  std::string database_;  // empty: SQLite's
  std::unique_ptr<JobStore> store_;
};

INSTANTIATE_TEST_SUITE_P(Backends, JobStoreTest,
                         testing::Values(Backend::kSqlite, Backend::kPostgres),
                         [](const auto& info) {
                           return info.param == Backend::kSqlite ? "Sqlite" : "Postgres";
                         });

class SqliteJobStoreTest : public JobStoreTest {};
INSTANTIATE_TEST_SUITE_P(Backends, SqliteJobStoreTest, testing::Values(Backend::kSqlite));

TEST_P(JobStoreTest, KeepsEveryFieldOfAJob) {
  JobRow job = Job("clinic", "jobs/1");
  job.request_id = "request";
  job.body = std::string("b\0dy", 4);
  job.upload = "uploads/1";
  job.options = std::string("\0\xFF", 2);
  job.priority = -1;
  job.threads = 3;
  job.trace = "00-0af7-01";
  job.volume = "volumes/1";
  job.state = JobState::kRunning;
  job.attempts = 2;
  job.crashes = 1;
  job.sequence = uint64_t{5} << 32;
  job.owner = "me";
  job.error = absl::InternalError("why");
  job.error.SetPayload("url", absl::Cord(std::string("\0x", 2)));
  job.started = Time(std::chrono::microseconds(1234567));
  job.number = Insert(job);
  Reopen();
  const JobRow found = **store_->FindJob("clinic", "jobs/1");
  EXPECT_EQ(found.number, job.number);
  EXPECT_EQ(found.request_id, job.request_id);
  EXPECT_EQ(found.body, job.body);
  EXPECT_EQ(found.upload, job.upload);
  EXPECT_EQ(found.options, job.options);
  EXPECT_EQ(found.priority, job.priority);
  EXPECT_EQ(found.threads, job.threads);
  EXPECT_EQ(found.trace, job.trace);
  EXPECT_EQ(found.created, job.created);
  EXPECT_EQ(found.volume, job.volume);
  EXPECT_EQ(found.state, job.state);
  EXPECT_EQ(found.attempts, job.attempts);
  EXPECT_EQ(found.crashes, job.crashes);
  EXPECT_EQ(found.sequence, job.sequence);
  EXPECT_EQ(found.owner, job.owner);
  EXPECT_EQ(found.error, job.error);
  EXPECT_EQ(found.started, job.started);
  EXPECT_EQ(found.ended, std::nullopt);
}

TEST_P(JobStoreTest, NeverChangesAJobThatHasEnded) {
  JobRow job = Job("clinic", "jobs/1");
  job.number = Insert(job);
  job.state = JobState::kCancelled;
  EXPECT_TRUE(*store_->UpdateJob(job));
  job.state = JobState::kSucceeded;
  EXPECT_FALSE(*store_->UpdateJob(job));
  EXPECT_EQ((*store_->FindJob("clinic", "jobs/1"))->state, JobState::kCancelled);
}

TEST_P(JobStoreTest, FindsNothingOfAnotherTenant) {
  JobRow job = Job("clinic", "jobs/1");
  job.request_id = "request";
  Insert(job);
  ASSERT_TRUE(store_
                  ->PutVolume({.tenant = "clinic",
                               .name = "volumes/1",
                               .declaration = {},
                               .blob_digest = "ab",
                               .volume_digest = "cd",
                               .size_bytes = 1,
                               .created = {},
                               .used = {}})
                  .ok());
  EXPECT_FALSE(store_->FindJob("other", "jobs/1")->has_value());
  EXPECT_FALSE(store_->FindJobOfRequest("other", "request")->has_value());
  EXPECT_FALSE(store_->FindVolume("other", "volumes/1")->has_value());
  EXPECT_THAT(*store_->FindVolumesOf("other", "ab"), IsEmpty());
  EXPECT_THAT(*store_->FindVolumesOf("clinic", "cd"), testing::SizeIs(1));
  EXPECT_THAT(*store_->ListJobs("other", std::nullopt, ~0u, 10), IsEmpty());
}

TEST_P(JobStoreTest, ListsTheNewestJobsFirstAndFiltersByState) {
  for (int n = 1; n <= 4; ++n) {
    JobRow job = Job("clinic", "jobs/" + std::to_string(n));
    if (n == 2) job.state = JobState::kFailed;
    job.created = Time(std::chrono::seconds(n / 2));  // 2 and 3 are of one time
    Insert(job);
  }
  const auto names = [](const std::vector<JobRow>& jobs) {
    std::string all;
    for (const JobRow& job : jobs) all += job.name.substr(5);
    return all;
  };
  const auto after = [](int n) {
    return JobPosition{.created = Time(std::chrono::seconds(n / 2)),
                       .name = "jobs/" + std::to_string(n)};
  };
  EXPECT_EQ(names(*store_->ListJobs("clinic", std::nullopt, ~0u, 10)), "4321");
  EXPECT_EQ(names(*store_->ListJobs("clinic", after(4), ~0u, 2)), "32");
  EXPECT_EQ(names(*store_->ListJobs("clinic", after(3), ~0u, 2)), "21");
  EXPECT_EQ(names(*store_->ListJobs("clinic", std::nullopt, 1u << 4, 10)), "2");
}

TEST_P(JobStoreTest, TakesBackAStepAndKeepsTheOthers) {
  ASSERT_TRUE(store_->Begin().ok());
  ASSERT_TRUE(store_->BeginStep().ok());
  Insert(Job("clinic", "jobs/kept"));
  ASSERT_TRUE(store_->KeepStep().ok());
  ASSERT_TRUE(store_->BeginStep().ok());
  Insert(Job("clinic", "jobs/undone"));
  ASSERT_TRUE(store_->UndoStep().ok());
  ASSERT_TRUE(store_->Commit().ok());
  EXPECT_TRUE(store_->FindJob("clinic", "jobs/kept")->has_value());
  EXPECT_FALSE(store_->FindJob("clinic", "jobs/undone")->has_value());
}

TEST_P(JobStoreTest, TakesAnyBytesForANameAndFindsNothing) {
  const std::string name("jobs/\0\xFF'", 8);
  Insert(Job("clinic", name));
  EXPECT_EQ((*store_->FindJob("clinic", name))->name, name);
  EXPECT_FALSE(store_->FindJob("clinic", "jobs/")->has_value());
}

TEST_P(JobStoreTest, CountsWhatTheFilesOfEachTenantTake) {
  const auto volume = [&](const std::string& name, const std::string& digest, uint64_t bytes) {
    VolumeRow row;
    row.tenant = "clinic";
    row.name = name;
    row.blob_digest = digest;
    row.size_bytes = bytes;
    EXPECT_TRUE(store_->PutVolume(row).ok());
  };
  volume("volumes/1", "a", 100);
  volume("volumes/2", "a", 100);  // the same bytes, declared differently
  volume("volumes/3", "b", 30);
  UploadRow upload;
  upload.tenant = "lab";
  upload.name = "uploads/1";
  upload.size_bytes = 7;
  EXPECT_TRUE(store_->InsertUpload(upload).ok());
  upload.name = "uploads/2";
  EXPECT_TRUE(store_->InsertUpload(upload).ok());
  upload.volume = "volumes/4";
  upload.file = "file";
  EXPECT_TRUE(store_->UpdateUpload(upload).ok());
  EXPECT_EQ((*store_->FindUpload("lab", "uploads/2"))->file, "file");
  ResultRow result;
  result.tenant = "lab";
  result.file = "file";
  result.bytes = 50;
  EXPECT_TRUE(store_->InsertResult(result).ok());
  EXPECT_THAT(*store_->DiskUse(),
              ElementsAre(testing::Pair("clinic", 130), testing::Pair("lab", 57)));
}

TEST_P(JobStoreTest, GivesUpAResultWithItsLastJob) {
  ResultRow result;
  result.tenant = "clinic";
  result.key = "key";
  result.file = "file";
  const int64_t number = *store_->InsertResult(result);
  EXPECT_EQ(*store_->InsertResult(result), number) << "the same key is the same result";
  std::vector<int64_t> jobs;
  for (const char* name : {"jobs/1", "jobs/2"}) {
    JobRow job = Job("clinic", name);
    job.result = number;
    jobs.push_back(Insert(job));
  }
  ASSERT_TRUE(store_->DeleteJob(jobs[0]).ok());
  EXPECT_FALSE(store_->TakeResultIfUnused(number)->has_value());
  ASSERT_TRUE(store_->DeleteJob(jobs[1]).ok());
  EXPECT_EQ((*store_->TakeResultIfUnused(number))->file, "file");
  EXPECT_FALSE(store_->FindResult(number)->has_value());
}

TEST_P(JobStoreTest, DeletesTheEventsOfAJobWithIt) {
  const int64_t job = Insert(Job("clinic", "jobs/1"));
  for (uint64_t sequence : {1U, 2U, 3U}) {
    EventRow event;
    event.job = job;
    event.sequence = sequence;
    ASSERT_TRUE(store_->InsertEvent(event).ok());
  }
  EXPECT_THAT(*store_->EventsAfter(job, 1),
              ElementsAre(Field(&EventRow::sequence, 2), Field(&EventRow::sequence, 3)));
  ASSERT_TRUE(store_->DeleteJob(job).ok());
  EXPECT_THAT(*store_->EventsAfter(job, 0), IsEmpty());
}

// Every single bit would be 300,000 openings: a few hundred, the same ones at every run.
TEST_P(SqliteJobStoreTest, GivesTheRightAnswerOrAnErrorWhateverBitIsFlipped) {
  constexpr int kJobs = 8, kFlips = 300;
  for (int n = 0; n < kJobs; ++n) {
    JobRow job = Job("clinic", "jobs/" + std::to_string(n));
    job.options = "options of " + std::to_string(n);
    job.volume = "volumes/" + std::to_string(n);
    job.attempts = n;
    Insert(job);
  }
  store_.reset();
  auto file = *File::OpenToWrite(folder_ / "jobs.db");
  const uint64_t size = *file.Size();
  std::mt19937_64 random(17);
  int told = 0;
  for (int flip = 0; flip < kFlips; ++flip) {
    const uint64_t bit = random() % (8 * size);
    const std::string byte = *file.ReadAt(bit / 8, 1);
    const auto damaged = static_cast<char>(byte[0] ^ (1 << (bit % 8)));
    ASSERT_TRUE(file.WriteAt(bit / 8, std::string(1, damaged)).ok());
    {
      const auto store = OpenSqliteJobStore(folder_ / "jobs.db");
      if (!store.ok()) ++told;
      for (int n = 0; store.ok() && n < kJobs; ++n) {
        const auto job = (*store)->FindJob("clinic", "jobs/" + std::to_string(n));
        if (!job.ok() && ++told > 0) continue;
        ASSERT_TRUE(job->has_value()) << bit;
        EXPECT_EQ((*job)->options, "options of " + std::to_string(n)) << bit;
        EXPECT_EQ((*job)->volume, "volumes/" + std::to_string(n)) << bit;
        EXPECT_EQ((*job)->attempts, n) << bit;
        EXPECT_EQ((*job)->state, JobState::kQueued) << bit;
      }
    }
    for (const char* log : {"jobs.db-wal", "jobs.db-shm"}) (void)RemoveFile(folder_ / log);
    ASSERT_TRUE(file.WriteAt(bit / 8, byte).ok());
  }
  EXPECT_GT(told, 0);
  Reopen();
}

// Two servers of a fleet.
class FleetStoreTest : public JobStoreTest {
 protected:
  void SetUp() override {
    JobStoreTest::SetUp();
    if (store_ == nullptr) return;
    auto other = Open();
    ASSERT_TRUE(other.ok()) << other.status();
    other_ = *std::move(other);
    ASSERT_TRUE(store_->Join("aa").ok());
    ASSERT_TRUE(other_->Join("bb").ok());
  }
  Member MemberOf(const std::string& server) {
    const auto members = *store_->Members();
    for (const Member& member : members) {
      if (member.server == server) return member;
    }
    return {};
  }
  std::unique_ptr<JobStore> other_;
};
INSTANTIATE_TEST_SUITE_P(Backends, FleetStoreTest, testing::Values(Backend::kPostgres));

TEST_P(FleetStoreTest, WhoIsFencedOffWritesNothing) {
  const Member seen = MemberOf("bb");
  ASSERT_TRUE(other_->Beat().ok());
  EXPECT_FALSE(*store_->Fence(seen)) << "it has given a sign of life since";
  EXPECT_TRUE(*store_->Fence(MemberOf("bb")));
  EXPECT_FALSE(other_->fenced());
  EXPECT_TRUE(absl::IsUnavailable(other_->Begin()));
  EXPECT_TRUE(other_->fenced());
  other_->Rollback();
  ASSERT_TRUE(store_->Begin().ok());
  ASSERT_TRUE(store_->Commit().ok());
  ASSERT_TRUE(other_->Join("cc").ok());
  ASSERT_TRUE(other_->Begin().ok());
  ASSERT_TRUE(other_->Commit().ok());
}

TEST_P(FleetStoreTest, OneWritesAtATime) {
  ASSERT_TRUE(store_->Begin().ok());
  Insert(Job("clinic", "jobs/1"));
  std::atomic<bool> begun = false;
  std::jthread second([&] {
    EXPECT_TRUE(other_->Begin().ok());
    begun = true;
    EXPECT_TRUE(other_->FindJob("clinic", "jobs/1")->has_value());
    EXPECT_TRUE(other_->Commit().ok());
  });
  for (int looks = 0; looks < 1000; ++looks) std::this_thread::yield();
  EXPECT_FALSE(begun);
  ASSERT_TRUE(store_->Commit().ok());
}

TEST_P(FleetStoreTest, TellsWhatOthersHaveChanged) {
  const JobChanges none = *other_->ChangesAfter(-1);
  EXPECT_THAT(none.jobs, IsEmpty());
  JobRow job = Job("clinic", "jobs/1");
  job.number = Insert(job);
  JobRow ended = Job("clinic", "jobs/2");
  ended.state = JobState::kFailed;
  ended.number = Insert(ended);
  EXPECT_THAT(other_->ChangesAfter(none.last)->jobs, testing::SizeIs(2));
  const JobChanges all = *other_->ChangesAfter(-1);
  EXPECT_THAT(all.jobs, ElementsAre(Field(&JobRow::name, "jobs/1")));
  EXPECT_EQ(other_->ChangesAfter(all.last)->last, all.last);
  job.state = JobState::kCancelled;
  ASSERT_TRUE(*store_->UpdateJob(job));
  const JobChanges changed = *other_->ChangesAfter(all.last);
  EXPECT_THAT(changed.jobs, ElementsAre(Field(&JobRow::state, JobState::kCancelled)));
  ASSERT_TRUE(store_->DeleteJob(job.number).ok());
  const JobChanges deleted = *other_->ChangesAfter(changed.last);
  EXPECT_THAT(deleted.jobs, IsEmpty());
  EXPECT_THAT(deleted.deleted, ElementsAre(job.number));
}

TEST_P(FleetStoreTest, KnowsWhetherEqualWorkRunsElsewhere) {
  JobRow job = Job("clinic", "jobs/1");
  job.options = "options";
  job.volume = "volumes/1";
  job.state = JobState::kRunning;
  job.owner = "aa";
  Insert(job);
  JobRow equal = job;
  EXPECT_TRUE(*other_->RunsElsewhere(equal, "", "bb"));
  EXPECT_FALSE(*other_->RunsElsewhere(equal, "", "aa")) << "that is its own";
  equal.volume = "volumes/2";
  EXPECT_FALSE(*other_->RunsElsewhere(equal, "cd", "bb"));
  VolumeRow volume;
  volume.tenant = "clinic";
  volume.name = "volumes/1";
  volume.volume_digest = "cd";
  ASSERT_TRUE(store_->PutVolume(volume).ok());
  EXPECT_TRUE(*other_->RunsElsewhere(equal, "cd", "bb")) << "the same points, encoded otherwise";
  equal.options = "others";
  EXPECT_FALSE(*other_->RunsElsewhere(equal, "cd", "bb"));
}

TEST_P(FleetStoreTest, GoesOnAfterTheDatabaseWasAway) {
  PostgresServer::Get()->Restart();
  EXPECT_FALSE(store_->FindJob("clinic", "jobs/1").ok());
  while (!store_->Begin().ok()) std::this_thread::yield();
  Insert(Job("clinic", "jobs/1"));
  ASSERT_TRUE(store_->Commit().ok());
  EXPECT_TRUE(store_->Health().ok());
  EXPECT_TRUE(store_->FindJob("clinic", "jobs/1")->has_value());
}

TEST_P(FleetStoreTest, OneOfManyServersMakesTheTables) {
  database_ = PostgresServer::Get()->NewDatabase();
  std::atomic<int> opened = 0;
  {
    std::vector<std::jthread> servers;
    for (int n = 0; n < 4; ++n) servers.emplace_back([&] { opened += Open().ok() ? 1 : 0; });
  }
  EXPECT_EQ(opened, 4);
}

TEST_P(FleetStoreTest, RefusesAPasswordThatOthersCouldSee) {
  EXPECT_EQ(OpenPostgresJobStore("postgresql://me:secret@/x").status().code(),
            absl::StatusCode::kInvalidArgument);
}

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
  const JobRow job = **(*store)->FindJob("clinic", "jobs/old");
  EXPECT_EQ(job.number, 5);
  EXPECT_EQ(job.state, JobState::kQueued);
  EXPECT_EQ(job.options, "\x03");
  EXPECT_EQ(job.threads, 0);
  EXPECT_EQ(job.trace, "");
  EXPECT_EQ(job.created, Time(std::chrono::seconds(3)));
  EXPECT_THAT(*(*store)->EventsAfter(5, 0), testing::SizeIs(1));
  EXPECT_EQ((*(*store)->FindVolume("clinic", "volumes/1"))->size_bytes, 7u);
  JobRow next;
  next.tenant = "clinic";
  next.name = "jobs/new";
  next.threads = 2;
  EXPECT_EQ(*(*store)->InsertJob(next), 6) << "numbers go on growing";
  EXPECT_EQ((*(*store)->FindJob("clinic", "jobs/new"))->threads, 2);
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
