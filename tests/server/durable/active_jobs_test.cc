#include "server/durable/active_jobs.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "server/durable/flow.h"
#include "tests/server/durable/fake_runner.h"

namespace bccskel::server {
namespace {

using std::chrono::milliseconds, std::chrono::minutes, std::chrono::seconds;

class EndCounter final : public RunObserver {
 public:
  Flow OnRunVolume(std::shared_ptr<Run>, std::string) override { return {}; }
  Flow OnRunProgress(std::shared_ptr<Run>) override { return {}; }
  Flow OnRunEnd(std::shared_ptr<Run>, absl::StatusOr<JobResult>) override {
    ++ends_;
    ends_.notify_all();
    return {};
  }
  void WaitForEnd() const { ends_.wait(0); }

 private:
  std::atomic<int> ends_{0};
};

class ActiveJobsTest : public testing::Test {
 protected:
  static JobRow Row(int64_t number, const std::string& tenant = "clinic") {
    JobRow row;
    row.number = number;
    row.tenant = tenant;
    row.options = "o";
    row.created = Time(seconds(number));
    return row;
  }
  static VolumeRow VolumeOf(const std::string& name, const std::string& digest = {}) {
    VolumeRow row;
    row.name = name;
    row.volume_digest = digest;
    return row;
  }
  void Queue(ActiveJobs& jobs, const JobRow& row) { jobs.Enqueue(jobs.Put(row)); }
  // 0: nobody's turn.
  int64_t Next(ActiveJobs& jobs, int max_runs = 1) {
    const auto turn = jobs.TakeNext(tenants_, max_runs);
    return turn.has_value() ? turn->job.number : 0;
  }
  // The job's volume is read from a file.
  ActiveRun& Begin(ActiveJobs& jobs, int64_t number, const std::string& volume = "volumes/1") {
    const JobRow row = jobs.Find(number)->row;
    auto run = std::make_shared<server::Run>(observer_, row.tenant, operations_.Begin());
    EXPECT_TRUE(run->Start(runner_, {}).ok());
    begun_.push_back(run);
    ActiveRun& active = jobs.AddRun(std::move(run), row, ActiveRun::Source::kFile);
    active.volume = volume;
    active.crashes = row.crashes;
    jobs.Attach(active, number);
    return active;
  }
  // A run and its job hold each other until the job ends.
  void TearDown() override {
    jobs_.ForgetRuns();
    for (const auto& run : begun_) run->Fail(absl::CancelledError("the test is over"));
  }

  EndCounter observer_;
  Operations operations_;
  FakeRunner runner_;
  std::vector<std::shared_ptr<server::Run>> begun_;
  TenantTable tenants_;
  ActiveJobs jobs_{/*shared=*/false, milliseconds(50)};
};

TEST_F(ActiveJobsTest, CountsJobsByTheirStateNow) {
  JobRow row = Row(1);
  row.state = JobState::kReceiving;
  jobs_.Put(row);
  EXPECT_EQ(jobs_.Count(JobState::kReceiving), 1);
  row.state = JobState::kQueued;
  jobs_.Put(row);
  EXPECT_EQ(jobs_.Count(JobState::kReceiving), 0);
  EXPECT_EQ(jobs_.Count(JobState::kQueued), 1);
  jobs_.Forget(1);
  EXPECT_EQ(jobs_.Count(JobState::kQueued), 0);
  EXPECT_EQ(jobs_.size(), 0u);
}

TEST_F(ActiveJobsTest, GivesTurnsToTheOldestUntilAllPlacesAreTaken) {
  for (const int64_t number : {3, 1, 2}) Queue(jobs_, Row(number));
  EXPECT_EQ(Next(jobs_, 2), 1);
  Begin(jobs_, 1, "volumes/1");
  EXPECT_EQ(Next(jobs_, 2), 2);
  Begin(jobs_, 2, "volumes/2");
  EXPECT_FALSE(jobs_.HasNext(tenants_, 2));
  EXPECT_EQ(Next(jobs_, 2), 0);
}

TEST_F(ActiveJobsTest, APlaceIsFreeWhileAResultIsStored) {
  Queue(jobs_, Row(1));
  Queue(jobs_, Row(2));
  EXPECT_EQ(Next(jobs_), 1);
  ActiveRun& run = Begin(jobs_, 1);
  EXPECT_EQ(Next(jobs_), 0);
  run.fed = RunPace::Clock::now() - seconds(10);  // a long one: none is begun ahead
  jobs_.Computed(run);
  EXPECT_EQ(Next(jobs_), 2);
}

TEST_F(ActiveJobsTest, BeginsShortOnesAheadAndOneThatWaitsForAPlaceNext) {
  for (int64_t number = 1; number <= 4; ++number) Queue(jobs_, Row(number));
  EXPECT_EQ(Next(jobs_), 1);
  ActiveRun& first = Begin(jobs_, 1, "volumes/1");
  first.fed = RunPace::Clock::now() - milliseconds(1);
  jobs_.Computed(first);
  EXPECT_EQ(Next(jobs_), 2);
  ActiveRun& second = Begin(jobs_, 2, "volumes/2");
  const auto ahead = jobs_.TakeNext(tenants_, 1);
  ASSERT_TRUE(ahead.has_value());
  EXPECT_TRUE(ahead->ahead);
  jobs_.WaitForPlace(ahead->job.number);
  EXPECT_EQ(Next(jobs_), 0) << "nobody overtakes it";
  jobs_.Computed(second);
  EXPECT_EQ(Next(jobs_), 3);
}

TEST_F(ActiveJobsTest, ATenantWithoutAPlaceNeedNotWaitForLongJobsOfOthers) {
  for (int64_t number = 1; number <= 4; ++number) Queue(jobs_, Row(number));
  for (const int64_t number : {1, 2}) {
    EXPECT_EQ(Next(jobs_, 2), number);
    Begin(jobs_, number, std::to_string(number)).fed = RunPace::Clock::now();
  }
  for (const int64_t number : {5, 6}) Queue(jobs_, Row(number, "lab"));
  Queue(jobs_, Row(7, "school"));
  EXPECT_FALSE(jobs_.HasNext(tenants_, 2)) << "they may end soon";
  for (const int64_t number : {1, 2}) {
    jobs_.FindRun(jobs_.Find(number)->run)->fed -= seconds(2);
  }
  EXPECT_EQ(Next(jobs_, 2), 5);
  Begin(jobs_, 5, "5");
  EXPECT_EQ(Next(jobs_, 2), 7) << "one for each tenant";
  Begin(jobs_, 7, "7");
  EXPECT_FALSE(jobs_.HasNext(tenants_, 2)) << "at most twice the places";
}

TEST_F(ActiveJobsTest, SuspectsStandBackAndRunOneAtATime) {
  JobRow first = Row(1), second = Row(2);
  first.crashes = second.crashes = 1;
  JobRow later = Row(3);
  later.created = Time(minutes(9));
  for (const JobRow& row : {first, second, later}) Queue(jobs_, row);
  EXPECT_EQ(Next(jobs_, 3), 3) << "suspects count as if they had come ten minutes later";
  Begin(jobs_, 3, "volumes/3");
  EXPECT_EQ(Next(jobs_, 3), 1);
  Begin(jobs_, 1, "volumes/1");
  EXPECT_EQ(Next(jobs_, 3), 0) << "one of them may be the reason";
  jobs_.ForgetRun(jobs_.Find(1)->run);
  EXPECT_EQ(Next(jobs_, 3), 2);
}

TEST_F(ActiveJobsTest, RunsElsewhereCountForATenantsCapWhereOthersShareTheStore) {
  tenants_.each.max_running = 1;
  for (const bool shared : {false, true}) {
    ActiveJobs jobs(shared, milliseconds(50));
    JobRow elsewhere = Row(1);
    elsewhere.state = JobState::kRunning;
    jobs.Put(elsewhere);
    Queue(jobs, Row(2));
    EXPECT_EQ(Next(jobs, 4), shared ? 0 : 2);
  }
}

TEST_F(ActiveJobsTest, FindsRunsOfTheSameTenantOptionsAndVolume) {
  jobs_.Put(Row(1));
  ActiveRun& run = Begin(jobs_, 1);
  run.volume_digest = "digest";
  const VolumeRow same = VolumeOf("volumes/1"), equal = VolumeOf("volumes/2", "digest");
  EXPECT_EQ(jobs_.FindEqual(Row(2), same), &run);
  EXPECT_EQ(jobs_.FindEqual(Row(2), equal), &run);
  EXPECT_EQ(jobs_.FindEqual(Row(2), VolumeOf("volumes/2")), nullptr) << "it is not decoded yet";
  EXPECT_EQ(jobs_.FindEqual(Row(2, "lab"), same), nullptr);
  JobRow other_options = Row(2);
  other_options.options = "p";
  EXPECT_EQ(jobs_.FindEqual(other_options, same), nullptr);
  run.ending = true;
  EXPECT_EQ(jobs_.FindEqual(Row(2), same), nullptr) << "who ends is not joined";
  EXPECT_EQ(jobs_.FindOpen(run.run.get()), nullptr);
  EXPECT_EQ(jobs_.FindRun(run.run.get()), &run);
}

TEST_F(ActiveJobsTest, TheLastWhoLeavesARunCancelsIt) {
  jobs_.Put(Row(1));
  jobs_.Put(Row(2));
  ActiveRun& run = Begin(jobs_, 1);
  jobs_.Attach(run, 2);
  jobs_.Forget(1);
  EXPECT_FALSE(run.run->cancelled());
  jobs_.Detach(2);
  EXPECT_TRUE(run.run->cancelled());
  EXPECT_EQ(jobs_.Find(2)->run, nullptr);
  observer_.WaitForEnd();
}

TEST_F(ActiveJobsTest, OneThatWaitsForAnEqualOneIsQueuedAgainUnlessItIsGoneOrRuns) {
  for (int64_t number = 1; number <= 3; ++number) {
    Queue(jobs_, Row(number));
    jobs_.WaitForEqual(*jobs_.Find(number));
  }
  EXPECT_EQ(Next(jobs_, 4), 0);
  jobs_.Forget(1);
  Begin(jobs_, 2);
  jobs_.QueueWaiting();
  EXPECT_EQ(Next(jobs_, 4), 3);
  EXPECT_EQ(Next(jobs_, 4), 0);
}

TEST_F(ActiveJobsTest, QueuesItsJobsAgainWhenAllRunsAreForgotten) {
  Queue(jobs_, Row(1));
  EXPECT_EQ(Next(jobs_), 1);
  const auto run = Begin(jobs_, 1).run;
  jobs_.ForgetRuns();
  EXPECT_TRUE(run->cancelled());
  EXPECT_EQ(jobs_.FindRun(run.get()), nullptr);
  EXPECT_EQ(Next(jobs_), 1);
}

}  // namespace
}  // namespace bccskel::server
