#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "server/errors/call_error.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::IsEmpty, testing::SizeIs;

class DurableJobsTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }
};

TEST_F(DurableJobsTest, ComputesAndKeepsTheResult) {
  const std::string job = MakeJob();
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kSucceeded) << ended.error;
  EXPECT_EQ(ended.result_records, 4u);
  EXPECT_EQ(ended.attempts, 1);
  const auto records = ReadResult("clinic", job);
  ASSERT_TRUE(records.ok()) << records.status();
  EXPECT_EQ((*records)[1].bytes, "volume 1");
  EXPECT_EQ((*records)[3].kind, ResultRecord::Kind::kSummary);
}

TEST_F(DurableJobsTest, ReadsAResultFromAnyRecordOn) {
  const std::string job = EndedJob();
  EXPECT_EQ(ReadResult("clinic", job, 2)->front().bytes, "volume 2");
  EXPECT_THAT(*ReadResult("clinic", job, 4), IsEmpty());
  EXPECT_EQ(ReadResult("clinic", job, 5).status().code(), absl::StatusCode::kOutOfRange);
}

TEST_F(DurableJobsTest, KeepsTheResultOverARestart) {
  const std::string job = EndedJob();
  Reopen();
  EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4));
}

TEST_F(DurableJobsTest, MakesOneJobOfAHundredEqualRequestsAtTheSameTime) {
  const std::string volume = Upload("clinic", "volume");
  std::vector<std::string> names(100);
  {
    std::vector<std::jthread> threads;
    for (std::string& name : names) {
      threads.emplace_back([&] { name = CreateName("clinic", JobOf(volume, "o", "request")); });
    }
  }
  EXPECT_THAT(std::set<std::string>(names.begin(), names.end()), SizeIs(1));
  WaitForEnd("clinic", names[0]);
  EXPECT_EQ(CreateName("clinic", JobOf(volume, "o", "request")), names[0]);
  EXPECT_EQ(runner_->started(), 1);
  const absl::Status reused = Create("clinic", JobOf(volume, "p", "request")).status();
  EXPECT_EQ(reused.code(), absl::StatusCode::kAlreadyExists);
  EXPECT_EQ(ReasonOf(reused), Reason::kRequestIdReused);
}

TEST_F(DurableJobsTest, RefusesAJobWithoutItsVolume) {
  const absl::Status missing = Create("clinic", JobOf("volumes/none")).status();
  EXPECT_EQ(missing.code(), absl::StatusCode::kFailedPrecondition);
  EXPECT_EQ(ReasonOf(missing), Reason::kVolumeMissing);
  EXPECT_EQ(Create("other", JobOf(Upload("clinic", "volume"))).status().code(),
            absl::StatusCode::kFailedPrecondition)
      << "another tenant's volume is none";
  EXPECT_EQ(Create("clinic", JobOf(Upload("clinic", "volume"), "bad")).status().code(),
            absl::StatusCode::kInvalidArgument);
}

TEST_F(DurableJobsTest, ChecksWithoutMakingAnything) {
  NewJob job = JobOf(Upload("clinic", "volume"), "o", "request");
  job.mode = NewJob::Mode::kValidateOnly;
  EXPECT_EQ(CreateName("clinic", job), "");
  job.options = "bad";
  EXPECT_FALSE(Create("clinic", job).ok());
  const auto page = List("clinic");
  EXPECT_THAT(page->jobs, IsEmpty());
}

TEST_F(DurableJobsTest, RefusesMoreJobsThanItHasPlaces) {
  Close();
  options_.max_unfinished_jobs = 2;
  Open();
  runner_->Hold();
  const std::string volume = Upload("clinic", "volume");
  CreateName("clinic", JobOf(volume));
  CreateName("clinic", JobOf(volume));
  EXPECT_EQ(ReasonOf(Create("clinic", JobOf(volume)).status()), Reason::kQueueFull);
}

TEST_F(DurableJobsTest, RefusesMoreJobsThanATenantMayHave) {
  Close();
  options_.max_unfinished_jobs = 10;
  TenantTable tenants;
  tenants.named["capped"].max_jobs = 2;
  tenants.named["clinic"] = tenants.named["lab"] = {};
  options_.tenants = [tenants] { return tenants; };
  Open();
  runner_->Hold();
  const auto made = [&](const std::string& tenant) {
    const std::string volume = Upload(tenant, "volume");
    int jobs = 0;
    absl::Status refused;
    while (refused.ok() && jobs < 20) {
      refused = Create(tenant, JobOf(volume)).status();
      if (refused.ok()) ++jobs;
    }
    EXPECT_EQ(ReasonOf(refused), Reason::kQueueFull);
    return jobs;
  };
  EXPECT_EQ(made("capped"), 2);
  EXPECT_EQ(made("clinic"), 4) << "half of what the others leave";
  EXPECT_EQ(made("lab"), 2);
}

TEST_F(DurableJobsTest, RefusesAJobThatCanNeverBeAdmitted) {
  Close();
  options_.max_job_bytes = 1000;
  Open();
  const std::string volume = Upload("clinic", "volume");
  EXPECT_EQ(ReasonOf(Create("clinic", JobOf(volume)).status()), Reason::kVolumeTooLarge);
}

TEST_F(DurableJobsTest, CancelsAJobThatRunsAndOneThatWaits) {
  Close();
  options_.max_runs = 1;
  Open();
  runner_->Hold();
  const std::string runs = MakeJob("one");
  WaitForState("clinic", runs, JobState::kRunning);
  runner_->WaitForComputing(1);
  const std::string waits = MakeJob("two");
  EXPECT_EQ(Cancel("clinic", waits)->state, JobState::kCancelled);
  EXPECT_EQ(Cancel("clinic", runs)->state, JobState::kCancelled);
  EXPECT_EQ(Cancel("clinic", runs)->state, JobState::kCancelled) << "once more";
  runner_->Release();
  EXPECT_EQ(WatchToTheEnd("clinic", waits)->States(), "15");
  EXPECT_EQ(WatchToTheEnd("clinic", runs)->States(), "125");
  const std::string next = MakeJob("three");
  EXPECT_EQ(WaitForEnd("clinic", next).state, JobState::kSucceeded) << "the place is free again";
  EXPECT_EQ(runner_->computed(), 1);
}

TEST_F(DurableJobsTest, BeginsShortJobsBeforeThereIsAPlaceButNoLargeOneAndNoneBeforeThat) {
  Close();
  options_.max_runs = 1;
  options_.soon = std::chrono::hours(1);  // however slow the machine is
  Open();
  const std::string volume = Upload("clinic", "volume");
  const auto make = [&](const std::string& options) {
    return CreateName("clinic", JobOf(volume, options));
  };
  WaitForEnd("clinic", make("so it is known how long they take"));
  runner_->Hold();
  const std::string first = make("first"), second = make("second");
  WaitForState("clinic", first, JobState::kRunning);
  WaitForState("clinic", second, JobState::kRunning);
  const std::string large = make("large"), third = make("third");
  EXPECT_EQ(GetJob("clinic", third)->state, JobState::kQueued);
  EXPECT_EQ(GetJob("clinic", large)->state, JobState::kQueued);  // what was to begin has begun
  EXPECT_EQ(GetJob("clinic", third)->state, JobState::kQueued);
  EXPECT_TRUE(Cancel("clinic", second).ok());
  runner_->Release();
  for (const std::string& job : {first, large, third}) {
    EXPECT_EQ(WaitForEnd("clinic", job).state, JobState::kSucceeded);
  }
}

TEST_F(DurableJobsTest, NeverChangesAJobThatHasEnded) {
  const std::string job = EndedJob();
  EXPECT_EQ(Cancel("clinic", job)->state, JobState::kSucceeded);
  EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4));
}

TEST_F(DurableJobsTest, ErasesTheResultOfADeletedJobUnlessAnotherHasIt) {
  const std::string volume = Upload("clinic", "volume");
  const std::string one = CreateName("clinic", JobOf(volume));
  WaitForEnd("clinic", one);
  const std::string two = CreateName("clinic", JobOf(volume));
  WaitForEnd("clinic", two);
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
  ASSERT_TRUE(Delete("clinic", one).ok());
  EXPECT_THAT(*ReadResult("clinic", two), SizeIs(4));
  EXPECT_EQ(GetJob("clinic", one).status().code(), absl::StatusCode::kNotFound);
  ASSERT_TRUE(Delete("clinic", two).ok());
  EXPECT_THAT(FilesIn("results"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 6u) << "the volume";
}

TEST_F(DurableJobsTest, CancelsAJobBeforeItIsDeleted) {
  runner_->Hold();
  const std::string job = MakeJob();
  runner_->WaitForComputing(1);
  const auto [watcher, handle] = Watch("clinic", job);
  ASSERT_TRUE(Delete("clinic", job).ok());
  EXPECT_TRUE(watcher->WaitForEnd().ok());
  EXPECT_EQ(watcher->States(), "125");
  runner_->Release();
  EXPECT_EQ(durable_jobs_->usage().running, 0);
}

TEST_F(DurableJobsTest, KeepsAVolumeThatAJobNeeds) {
  runner_->Hold();
  const std::string volume = Upload("clinic", "volume");
  const std::string job = CreateName("clinic", JobOf(volume));
  EXPECT_EQ(DeleteVolume("clinic", volume).code(), absl::StatusCode::kFailedPrecondition);
  ASSERT_TRUE(Cancel("clinic", job).ok());
  EXPECT_TRUE(DeleteVolume("clinic", volume).ok());
}

TEST_F(DurableJobsTest, TellsEventsInOrderAndProgressInBetween) {
  runner_->Hold();
  const std::string job = MakeJob();
  const auto [watcher, handle] = Watch("clinic", job);
  runner_->WaitForComputing(1);
  runner_->Release();
  ASSERT_TRUE(watcher->WaitForEnd().ok());
  EXPECT_EQ(watcher->States(), "123");
  uint64_t last = 0;
  const JobProgress* progress = nullptr;
  const std::vector<JobEvent> events = watcher->events();
  for (const JobEvent& event : events) {
    EXPECT_GT(event.sequence, last);
    last = event.sequence;
    if (const auto* now = std::get_if<JobProgress>(&event.what)) progress = now;
  }
  ASSERT_NE(progress, nullptr);
  EXPECT_EQ(progress->shell.shell, 3) << "the last shell is always told";
  EXPECT_TRUE(events.back().IsCompleted());
}

TEST_F(DurableJobsTest, WatchesNothingThatIsNotThere) {
  auto watcher = std::make_shared<RememberingWatcher>();
  const std::string job = MakeJob();
  const auto handle = durable_jobs_->WatchJob("other", job, 0, watcher);
  EXPECT_EQ(watcher->WaitForEnd().code(), absl::StatusCode::kNotFound);
}

TEST_F(DurableJobsTest, EndsWatchesWhenItStops) {
  runner_->Hold();
  const std::string job = MakeJob();
  const auto [watcher, handle] = Watch("clinic", job);
  Close();
  EXPECT_EQ(watcher->WaitForEnd().code(), absl::StatusCode::kUnavailable);
}

// The rule of all jobs (jobs/fair_queue.h).
TEST_F(DurableJobsTest, LetsTenantsTakeTurnsByWeightAndNoJobStarve) {
  Close();
  std::mutex mutex;
  std::string order;  // first letters of the tenants whose jobs begin
  options_.max_runs = 1;
  options_.tenants = [] {
    return TenantTable{.each = {}, .named = {{"heavy", {.weight = 3}}, {"light", {}}}};
  };
  options_.on_job_state = [&](const JobRow& job) {
    const std::lock_guard lock(mutex);
    if (job.state == JobState::kRunning) order += job.priority < 0 ? 'L' : job.tenant[0];
  };
  Open();
  runner_->Hold();
  std::vector<std::pair<std::string, std::string>> made;
  const auto create = [&](const std::string& tenant, int number, int priority) {
    NewJob job = JobOf(Upload(tenant, std::to_string(number)), std::to_string(number));
    job.priority = priority;
    made.emplace_back(tenant, CreateName(tenant, job));
  };
  create("other", 0, 0);
  WaitForState("other", made.front().second, JobState::kRunning);
  create("light", 0, -1);
  Wait(std::chrono::seconds(61));  // worth two levels of priority
  for (int n = 1; n <= 6; ++n) create("heavy", n, 0);
  for (int n = 1; n <= 2; ++n) create("light", n, 1);
  runner_->Release();
  for (const auto& [tenant, job] : made) WaitForEnd(tenant, job);
  Close();
  EXPECT_EQ(std::count(order.begin(), order.end(), 'h'), 6);
  EXPECT_EQ(std::count(order.begin(), order.begin() + 5, 'h'), 3) << order;
  EXPECT_LT(order.find('L'), order.find('l')) << order;
}

}  // namespace
}  // namespace bccskel::server
