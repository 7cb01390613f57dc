#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <string>
#include <thread>
#include <vector>

#include "tests/server/store/job_store_fixture.h"

namespace bccskel::server {
namespace {

using testing::ElementsAre, testing::Field, testing::IsEmpty;

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
    EXPECT_TRUE(other_->Find<JobRow>("clinic", "jobs/1")->has_value());
    EXPECT_TRUE(other_->Commit().ok());
  });
  // Not until the database ends a transaction that does nothing, after 4 s.
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
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
  ASSERT_TRUE(store_->Put(volume).ok());
  EXPECT_TRUE(*other_->RunsElsewhere(equal, "cd", "bb")) << "the same points, encoded otherwise";
  equal.options = "others";
  EXPECT_FALSE(*other_->RunsElsewhere(equal, "cd", "bb"));
}

TEST_P(FleetStoreTest, GoesOnAfterTheDatabaseWasAway) {
  PostgresServer::Get()->Restart();
  EXPECT_FALSE(store_->Find<JobRow>("clinic", "jobs/1").ok());
  while (!store_->Begin().ok()) std::this_thread::yield();
  Insert(Job("clinic", "jobs/1"));
  ASSERT_TRUE(store_->Commit().ok());
  EXPECT_TRUE(store_->Health().ok());
  EXPECT_TRUE(store_->Find<JobRow>("clinic", "jobs/1")->has_value());
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

TEST_P(FleetStoreTest, OthersSeeTheNewestProgressOfAJob) {
  const int64_t job = Insert(Job("clinic", "jobs/a"));
  EXPECT_FALSE(other_->FindProgress(job)->has_value());
  for (const uint64_t sequence : {3u, 9u}) {
    ASSERT_TRUE(store_->PutProgress(job, {.sequence = sequence, .bytes = "p"}).ok());
  }
  EXPECT_EQ((*other_->FindProgress(job))->sequence, 9u);
  ASSERT_TRUE(store_->DeleteJob(job).ok());
  EXPECT_FALSE(other_->FindProgress(job)->has_value());
}

}  // namespace
}  // namespace bccskel::server
