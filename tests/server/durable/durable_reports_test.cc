#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <mutex>
#include <string>
#include <vector>

#include "server/errors/call_error.h"
#include "tests/server/durable/durable_fixture.h"

// What DurableJobs tells of jobs and their errors, to callers and to the log.

namespace bccskel::server {
namespace {

using testing::ElementsAre, testing::HasSubstr, testing::SizeIs;

class DurableReportsTest : public DurableTest {
 protected:
  DurableReportsTest() {
    options_.on_job_state = [this](const JobRow& job) {
      std::lock_guard lock(mutex_);
      rows_.push_back(job);
    };
  }
  void SetUp() override { Open(); }
  void TearDown() override {  // before what they report to
    killed_.clear();
    Close();
  }

  // A job with a trace, in state kSucceeded.
  std::string EndedTracedJob() {
    const std::string job = CreateName("clinic", TracedJob());
    WaitForEnd("clinic", job);
    return job;
  }
  NewJob TracedJob() {
    NewJob job = JobOf(Upload("clinic", "volume"));
    job.trace = "trace";
    return job;
  }
  // All that was reported.
  std::vector<JobRow> Rows() {
    std::lock_guard lock(mutex_);
    return rows_;
  }
  std::vector<JobState> States() {
    std::vector<JobState> states;
    for (const JobRow& row : Rows()) states.push_back(row.state);
    return states;
  }

  std::mutex mutex_;
  std::vector<JobRow> rows_;  // guarded by mutex_
};

TEST_F(DurableReportsTest, EveryStateWithTheTraceOfTheCallThatMadeTheJob) {
  const std::string job = EndedTracedJob();
  EXPECT_THAT(States(), ElementsAre(JobState::kQueued, JobState::kRunning, JobState::kSucceeded));
  for (const JobRow& row : Rows()) {
    EXPECT_EQ(row.name, job);
    EXPECT_EQ(row.tenant, "clinic");
    EXPECT_EQ(row.trace, "trace");
  }
  EXPECT_EQ(Rows().back().attempts, 1);
  CreateName("clinic", TracedJob());
  EXPECT_EQ(States().back(), JobState::kSucceeded) << "that was given a stored result";
}

TEST_F(DurableReportsTest, TheTraceOfAJobThatCameWithItsVolume) {
  const auto begun = CreateUpload(
      "clinic",
      {.declaration = "6", .then_job = NewUpload::ThenJob{.options = "o", .trace = "trace"}});
  ASSERT_TRUE(begun.ok()) << begun.status();
  EXPECT_EQ(Rows().at(0).state, JobState::kReceiving);
  EXPECT_EQ(Rows().at(0).trace, "trace");
}

TEST_F(DurableReportsTest, TheEndAlsoToWhoKnowsIt) {
  const std::string job = EndedTracedJob();
  const uint64_t last = GetJob("clinic", job)->sequence;
  for (const uint64_t after : {last, last + 1, ~uint64_t{0}}) {
    const auto events = WatchToTheEnd("clinic", job, after)->events();
    ASSERT_THAT(events, SizeIs(1)) << after;
    EXPECT_TRUE(events[0].IsCompleted());
    EXPECT_EQ(events[0].sequence, last);
  }
}

TEST_F(DurableReportsTest, TheEndToWhoWaitsForLaterEventsThanThereWillBe) {
  runner_->Hold();
  const std::string job = CreateName("clinic", TracedJob());
  const auto [watcher, handle] = Watch("clinic", job, 1000);
  runner_->WaitForComputing(1);
  runner_->Release();
  EXPECT_TRUE(watcher->WaitForEnd().ok());
  EXPECT_EQ(watcher->States(), "3");
}

TEST_F(DurableReportsTest, WhichJobARequestIdHasMade) {
  NewJob job = TracedJob();
  job.request_id = "request";
  const std::string first = CreateName("clinic", job);
  job.trace = "another";
  EXPECT_EQ(CreateName("clinic", job), first) << "a trace makes no other request";
  job.options = "p";
  const absl::Status reused = Create("clinic", job).status();
  ASSERT_TRUE(ReasonOf(reused).has_value()) << reused;
  EXPECT_EQ(ReasonOf(reused), Reason::kRequestIdReused);
  EXPECT_EQ(DetailsOf(reused).value, first);
  EXPECT_THAT(std::string(reused.message()), HasSubstr(first));
}

TEST_F(DurableReportsTest, HowMuchCanStillBeWritten) {
  EXPECT_GT(durable_jobs_->usage().disk_available_bytes, 0u);
  Close();
  options_.max_disk_bytes = 1000;
  Open();
  const uint64_t free = durable_jobs_->usage().disk_available_bytes;
  EXPECT_EQ(free, 1000u);
  Upload("clinic", "volume");
  EXPECT_EQ(durable_jobs_->usage().disk_available_bytes, free - 6);
}

}  // namespace
}  // namespace bccskel::server
