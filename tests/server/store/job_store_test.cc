#include "server/store/job_store.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

#include "server/store/file_io.h"
#include "tests/server/store/job_store_fixture.h"

namespace bccskel::server {
namespace {

using testing::ElementsAre, testing::Field, testing::IsEmpty;

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
  const JobRow found = **store_->Find<JobRow>("clinic", "jobs/1");
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
  EXPECT_EQ((*store_->Find<JobRow>("clinic", "jobs/1"))->state, JobState::kCancelled);
}

TEST_P(JobStoreTest, FindsNothingOfAnotherTenant) {
  JobRow job = Job("clinic", "jobs/1");
  job.request_id = "request";
  Insert(job);
  ASSERT_TRUE(store_
                  ->Put(VolumeRow{.tenant = "clinic",
                                  .name = "volumes/1",
                                  .declaration = {},
                                  .blob_digest = "ab",
                                  .volume_digest = "cd",
                                  .size_bytes = 1,
                                  .created = {},
                                  .used = {}})
                  .ok());
  EXPECT_FALSE(store_->Find<JobRow>("other", "jobs/1")->has_value());
  EXPECT_FALSE(store_->FindJobOfRequest("other", "request")->has_value());
  EXPECT_FALSE(store_->Find<VolumeRow>("other", "volumes/1")->has_value());
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
  EXPECT_TRUE(store_->Find<JobRow>("clinic", "jobs/kept")->has_value());
  EXPECT_FALSE(store_->Find<JobRow>("clinic", "jobs/undone")->has_value());
}

TEST_P(JobStoreTest, TakesAnyBytesForANameAndFindsNothing) {
  const std::string name("jobs/\0\xFF'", 8);
  Insert(Job("clinic", name));
  EXPECT_EQ((*store_->Find<JobRow>("clinic", name))->name, name);
  EXPECT_FALSE(store_->Find<JobRow>("clinic", "jobs/")->has_value());
}

TEST_P(JobStoreTest, CountsWhatTheFilesOfEachTenantTake) {
  const auto volume = [&](const std::string& name, const std::string& digest, uint64_t bytes) {
    VolumeRow row;
    row.tenant = "clinic";
    row.name = name;
    row.blob_digest = digest;
    row.size_bytes = bytes;
    EXPECT_TRUE(store_->Put(row).ok());
  };
  volume("volumes/1", "a", 100);
  volume("volumes/2", "a", 100);  // the same bytes, declared differently
  volume("volumes/3", "b", 30);
  UploadRow upload;
  upload.tenant = "lab";
  upload.name = "uploads/1";
  upload.size_bytes = 7;
  EXPECT_TRUE(store_->Insert(upload).ok());
  upload.name = "uploads/2";
  EXPECT_TRUE(store_->Insert(upload).ok());
  upload.volume = "volumes/4";
  upload.file = "file";
  EXPECT_TRUE(store_->Put(upload).ok());
  EXPECT_EQ((*store_->Find<UploadRow>("lab", "uploads/2"))->file, "file");
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
  const int64_t number = store_->InsertResult(result)->number;
  EXPECT_EQ(store_->InsertResult(result)->number, number) << "the same key is the same result";
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
    ASSERT_TRUE(store_->Insert(event).ok());
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
        const auto job = (*store)->Find<JobRow>("clinic", "jobs/" + std::to_string(n));
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

}  // namespace
}  // namespace bccskel::server
