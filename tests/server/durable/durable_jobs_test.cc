#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "server/errors/call_error.h"
#include "server/store/file_io.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

class DurableJobsTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }
  void FlipABit(const std::string& path) {
    auto file = *File::OpenToWrite(path);
    std::string byte = *file.ReadAt(2, 1);
    byte[0] = static_cast<char>(byte[0] ^ 1);
    ASSERT_TRUE(file.WriteAt(2, byte).ok());
  }
};

TEST_F(DurableJobsTest, ComputesAndKeepsTheResult) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
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
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
  EXPECT_EQ(ReadResult("clinic", job, 2)->front().bytes, "volume 2");
  EXPECT_THAT(*ReadResult("clinic", job, 4), IsEmpty());
  EXPECT_EQ(ReadResult("clinic", job, 5).status().code(), absl::StatusCode::kOutOfRange);
}

TEST_F(DurableJobsTest, KeepsTheResultOverARestart) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
  Close();
  Open();
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
  const auto page = Get<JobPage>([&](auto done) { durable_jobs_->ListJobs("clinic", {}, done); });
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
  const std::string runs = CreateName("clinic", JobOf(Upload("clinic", "one")));
  WaitForState("clinic", runs, JobState::kRunning);
  runner_->WaitForComputing(1);
  const std::string waits = CreateName("clinic", JobOf(Upload("clinic", "two")));
  EXPECT_EQ(Cancel("clinic", waits)->state, JobState::kCancelled);
  EXPECT_EQ(Cancel("clinic", runs)->state, JobState::kCancelled);
  EXPECT_EQ(Cancel("clinic", runs)->state, JobState::kCancelled) << "once more";
  runner_->Release();
  EXPECT_EQ(WatchToTheEnd("clinic", waits)->States(), "15");
  EXPECT_EQ(WatchToTheEnd("clinic", runs)->States(), "125");
  const std::string next = CreateName("clinic", JobOf(Upload("clinic", "three")));
  EXPECT_EQ(WaitForEnd("clinic", next).state, JobState::kSucceeded) << "the place is free again";
  EXPECT_EQ(runner_->computed(), 1);
}

TEST_F(DurableJobsTest, NeverChangesAJobThatHasEnded) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
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
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  runner_->WaitForComputing(1);
  auto watcher = std::make_shared<RememberingWatcher>();
  const auto handle = durable_jobs_->WatchJob("clinic", job, 0, watcher);
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
  const auto erase = [&] {
    return GetStatus([&](auto done) { durable_jobs_->DeleteVolume("clinic", volume, done); });
  };
  EXPECT_EQ(erase().code(), absl::StatusCode::kFailedPrecondition);
  ASSERT_TRUE(Cancel("clinic", job).ok());
  EXPECT_TRUE(erase().ok());
}

TEST_F(DurableJobsTest, TellsEventsInOrderAndProgressInBetween) {
  runner_->Hold();
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  auto watcher = std::make_shared<RememberingWatcher>();
  const auto handle = durable_jobs_->WatchJob("clinic", job, 0, watcher);
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
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  const auto handle = durable_jobs_->WatchJob("other", job, 0, watcher);
  EXPECT_EQ(watcher->WaitForEnd().code(), absl::StatusCode::kNotFound);
}

TEST_F(DurableJobsTest, EndsWatchesWhenItStops) {
  runner_->Hold();
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  auto watcher = std::make_shared<RememberingWatcher>();
  const auto handle = durable_jobs_->WatchJob("clinic", job, 0, watcher);
  Close();
  EXPECT_EQ(watcher->WaitForEnd().code(), absl::StatusCode::kUnavailable);
}

TEST_F(DurableJobsTest, GivesAnEqualJobTheStoredResult) {
  const std::string volume = Upload("clinic", "volume");
  WaitForEnd("clinic", CreateName("clinic", JobOf(volume)));
  const auto again = Create("clinic", JobOf(volume));
  EXPECT_EQ(again->state, JobState::kSucceeded) << "at once";
  EXPECT_THAT(*ReadResult("clinic", again->name), SizeIs(4));
  WaitForEnd("clinic", CreateName("clinic", JobOf(volume, "other options")));
  EXPECT_EQ(runner_->computed(), 2);
  EXPECT_EQ(durable_jobs_->usage().cached, 1u);
}

TEST_F(DurableJobsTest, GivesAnEqualVolumeInAnotherEncodingTheStoredResult) {
  WaitForEnd("clinic", CreateName("clinic", JobOf(Upload("clinic", "volume|raw"))));
  const std::string again = CreateName("clinic", JobOf(Upload("clinic", "volume|zipped")));
  EXPECT_EQ(WaitForEnd("clinic", again).state, JobState::kSucceeded);
  Close();  // a result that came too late is then gone
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
}

TEST_F(DurableJobsTest, DoesNotGiveResultsOfAnotherAlgorithmOrTenant) {
  WaitForEnd("clinic", CreateName("clinic", JobOf(Upload("clinic", "volume"))));
  WaitForEnd("other", CreateName("other", JobOf(Upload("other", "volume"))));
  Close();
  options_.algorithm_version = "2";
  Open();
  WaitForEnd("clinic", CreateName("clinic", JobOf(Upload("clinic", "volume"))));
  EXPECT_EQ(runner_->computed(), 3);
}

TEST_F(DurableJobsTest, RunsEqualJobsInFlightOnce) {
  runner_->Hold();
  const std::string raw = Upload("clinic", "volume|raw"), zip = Upload("clinic", "volume|zip");
  const std::string one = CreateName("clinic", JobOf(raw));
  runner_->WaitForComputing(1);
  const std::string two = CreateName("clinic", JobOf(raw)),
                    three = CreateName("clinic", JobOf(zip));
  runner_->WaitForComputing(2);
  const std::string gone = CreateName("clinic", JobOf(raw));
  ASSERT_TRUE(Cancel("clinic", one).ok()) << "the first may leave";
  ASSERT_TRUE(Cancel("clinic", gone).ok());
  WaitForState("clinic", two, JobState::kRunning);
  runner_->Release();
  EXPECT_EQ(WaitForEnd("clinic", two).state, JobState::kSucceeded);
  EXPECT_EQ(WaitForEnd("clinic", three).state, JobState::kSucceeded);
  Close();
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
  EXPECT_EQ(runner_->started(), 2) << "the second encoding had to be decoded to be known";
}

TEST_F(DurableJobsTest, WaitsForARunnerThatIsBusy) {
  const std::string volume = Upload("clinic", "volume");
  runner_->Refuse(CallError(Reason::kMemoryBusy, "busy"));
  const std::string job = CreateName("clinic", JobOf(volume));
  EXPECT_EQ(GetJob("clinic", job)->state, JobState::kQueued);
  runner_->Refuse(absl::OkStatus());
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kSucceeded);
  EXPECT_EQ(ended.attempts, 1) << "a refusal is no attempt";
}

TEST_F(DurableJobsTest, FailsWithTheRunnersError) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "bad!")));
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(DurableJobsTest, TellsADamagedVolume) {
  const std::string volume = Upload("clinic", "volume");
  FlipABit(FilesIn("blobs").at(0));
  const JobInfo ended = WaitForEnd("clinic", CreateName("clinic", JobOf(volume)));
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(ended.error.message()), HasSubstr(Sha256Of("volume").Hex()));
  EXPECT_EQ(runner_->computed(), 0) << "nothing is computed from damaged bytes";
  EXPECT_EQ(Upload("clinic", "volume"), volume) << "sending it again mends it";
  EXPECT_EQ(WaitForEnd("clinic", CreateName("clinic", JobOf(volume))).state, JobState::kSucceeded);
}

TEST_F(DurableJobsTest, TellsADamagedResult) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
  FlipABit(FilesIn("results").at(0));
  EXPECT_EQ(ReadResult("clinic", job).status().code(), absl::StatusCode::kDataLoss);
}

TEST_F(DurableJobsTest, MakesADamagedResultAnewAndHealsAllWhoShareIt) {
  const std::string volume = Upload("clinic", "volume");
  const std::string first = CreateName("clinic", JobOf(volume));
  WaitForEnd("clinic", first);
  const std::string second = CreateName("clinic", JobOf(volume));
  EXPECT_EQ(durable_jobs_->usage().cached, 1u);
  FlipABit(FilesIn("results").at(0));
  ASSERT_TRUE(Delete("clinic", first).ok());
  const std::string third = CreateName("clinic", JobOf(volume));
  EXPECT_EQ(WaitForEnd("clinic", third).state, JobState::kSucceeded);
  EXPECT_EQ(runner_->computed(), 2) << "a damaged result is given to nobody";
  for (const std::string& job : {second, third}) {
    EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4)) << job;
  }
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
  const uint64_t used = durable_jobs_->usage().disk_bytes;
  Close();
  Open();
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, used);
}

TEST_F(DurableJobsTest, KnowsNoVolumeWhoseFileIsGone) {
  const std::string volume = Upload("clinic", "volume");
  const std::string digest = Sha256Of("volume").Hex();
  const auto find = [&] {
    return Get<std::vector<VolumeInfo>>(
        [&](auto done) { durable_jobs_->FindVolumes("clinic", {digest}, done); });
  };
  EXPECT_THAT(*find(), SizeIs(1));
  std::filesystem::remove(FilesIn("blobs").at(0));
  EXPECT_THAT(*find(), IsEmpty());
  EXPECT_EQ(ReasonOf(Create("clinic", JobOf(volume)).status()), Reason::kVolumeMissing);
  EXPECT_EQ(Upload("clinic", "volume"), volume);
  EXPECT_THAT(*find(), SizeIs(1));
}

TEST_F(DurableJobsTest, LetsNothingExpireByAClockThatHasLeapt) {
  Close();
  options_.believable_leap = std::chrono::hours(24);
  Open();
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
  Close();
  Wait(std::chrono::hours(24 * 365));
  Open();
  EXPECT_TRUE(GetJob("clinic", job).ok()) << "the clock was wrong when the server started";
  Close();
  Open();
  EXPECT_TRUE(GetJob("clinic", job).ok()) << "another start does not make it right";
  Wait(-std::chrono::hours(24 * 365));
  Close();
  Open();
  EXPECT_EQ(GetJob("clinic", job)->state, JobState::kSucceeded);
  EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4));
}

TEST_F(DurableJobsTest, CleansUpAgainAfterAReadingFarAhead) {
  std::atomic<int> doubts = 0;
  Close();
  options_.believable_leap = std::chrono::hours(24);
  options_.on_warning = [&](const std::string&) { ++doubts; };
  Open();
  const auto wait_for_doubt = [&](int number) {
    while (doubts < number) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  };
  Wait(std::chrono::hours(24 * 365));
  wait_for_doubt(1);
  Wait(-std::chrono::hours(24 * 365));
  wait_for_doubt(2);  // the next clean-up, and not one in a year
  Close();
}

TEST_F(DurableJobsTest, FailsAJobWhoseResultDoesNotFitOnTheDisk) {
  Close();
  options_.max_disk_bytes = 20;
  Open();
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(FilesIn("results"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 6u);
}

TEST_F(DurableJobsTest, ForgetsResultsAfterTheirTime) {
  const std::string job = CreateName("clinic", JobOf(Upload("clinic", "volume")));
  WaitForEnd("clinic", job);
  Wait(options_.keep_results + std::chrono::seconds(10));
  Close();
  Open();
  EXPECT_EQ(GetJob("clinic", job).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(FilesIn("results"), IsEmpty());
}

}  // namespace
}  // namespace bccskel::server
