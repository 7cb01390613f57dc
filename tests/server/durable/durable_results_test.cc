#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <string>

#include "server/errors/call_error.h"
#include "server/store/file_io.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr, testing::IsEmpty, testing::SizeIs;

class DurableResultsTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }
  void FlipABit(const std::string& path) {
    auto file = *File::OpenToWrite(path);
    std::string byte = *file.ReadAt(2, 1);
    byte[0] = static_cast<char>(byte[0] ^ 1);
    ASSERT_TRUE(file.WriteAt(2, byte).ok());
  }
};

TEST_F(DurableResultsTest, GivesAnEqualJobTheStoredResult) {
  const std::string volume = Upload("clinic", "volume");
  WaitForEnd("clinic", CreateName("clinic", JobOf(volume)));
  const auto again = Create("clinic", JobOf(volume));
  EXPECT_EQ(again->state, JobState::kSucceeded) << "at once";
  EXPECT_THAT(*ReadResult("clinic", again->name), SizeIs(4));
  WaitForEnd("clinic", CreateName("clinic", JobOf(volume, "other options")));
  EXPECT_EQ(runner_->computed(), 2);
  EXPECT_EQ(durable_jobs_->usage().cached, 1u);
}

TEST_F(DurableResultsTest, GivesAnEqualVolumeInAnotherEncodingTheStoredResult) {
  WaitForEnd("clinic", MakeJob("volume|raw"));
  const std::string again = MakeJob("volume|zipped");
  EXPECT_EQ(WaitForEnd("clinic", again).state, JobState::kSucceeded);
  Close();  // a result that came too late is then gone
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
}

TEST_F(DurableResultsTest, DoesNotGiveResultsOfAnotherAlgorithmOrTenant) {
  EndedJob();
  WaitForEnd("other", CreateName("other", JobOf(Upload("other", "volume"))));
  Close();
  options_.algorithm_version = "2";
  Open();
  EndedJob();
  EXPECT_EQ(runner_->computed(), 3);
}

TEST_F(DurableResultsTest, RunsEqualJobsInFlightOnce) {
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

TEST_F(DurableResultsTest, WaitsForARunnerThatIsBusy) {
  const std::string volume = Upload("clinic", "volume");
  runner_->Refuse(CallError(Reason::kMemoryBusy, "busy"));
  const std::string job = CreateName("clinic", JobOf(volume));
  EXPECT_EQ(GetJob("clinic", job)->state, JobState::kQueued);
  runner_->Refuse(absl::OkStatus());
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kSucceeded);
  EXPECT_EQ(ended.attempts, 1) << "a refusal is no attempt";
}

TEST_F(DurableResultsTest, WaitsForTheMemoryThatItLackedWhileItRan) {
  runner_->RunShort(100);
  const std::string job = MakeJob();
  JobInfo waiting = *GetJob("clinic", job);
  while (waiting.attempts == 0 || waiting.state == JobState::kRunning) {
    waiting = *GetJob("clinic", job);
  }
  EXPECT_EQ(ReasonOf(waiting.error), Reason::kMemoryBusy) << waiting.error;
  runner_->RunShort(0);
  const auto watcher = WatchToTheEnd("clinic", job);
  EXPECT_EQ(watcher->States(), "12123") << "it waited and did not try in vain";
  EXPECT_EQ(runner_->min_bytes(), 100u);
  const JobInfo ended = *GetJob("clinic", job);
  EXPECT_EQ(ended.attempts, 2);
  EXPECT_TRUE(ended.error.ok()) << ended.error;
}

TEST_F(DurableResultsTest, FailsWithTheRunnersError) {
  const std::string job = MakeJob("bad!");
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kInvalidArgument);
}

TEST_F(DurableResultsTest, TellsADamagedVolume) {
  const std::string volume = Upload("clinic", "volume");
  FlipABit(FilesIn("blobs").at(0));
  const JobInfo ended = WaitForEnd("clinic", CreateName("clinic", JobOf(volume)));
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kDataLoss);
  EXPECT_THAT(std::string(ended.error.message()), HasSubstr(Sha256Of("volume").Hex()));
  EXPECT_EQ(runner_->computed(), 0) << "nothing is computed from damaged bytes";
  EXPECT_EQ(Upload("clinic", "volume"), volume) << "sending it again mends it";
  EXPECT_EQ(WaitForEnd("clinic", CreateName("clinic", JobOf(volume))).state, JobState::kSucceeded);
}

TEST_F(DurableResultsTest, TellsADamagedVolumeThatCannotBeDecodedFromOneThatCameSo) {
  const std::string volume = Upload("clinic", "volume");
  std::ofstream(FilesIn("blobs").at(0), std::ios::in) << "vol!";
  const JobInfo ended = WaitForEnd("clinic", CreateName("clinic", JobOf(volume)));
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kDataLoss) << ended.error;
  EXPECT_EQ(Upload("clinic", "volume"), volume) << "sending it again mends it";
  EXPECT_EQ(WaitForEnd("clinic", CreateName("clinic", JobOf(volume))).state, JobState::kSucceeded);
}

TEST_F(DurableResultsTest, TellsADamagedResult) {
  const std::string job = EndedJob();
  FlipABit(FilesIn("results").at(0));
  EXPECT_EQ(ReadResult("clinic", job).status().code(), absl::StatusCode::kDataLoss);
}

TEST_F(DurableResultsTest, MakesADamagedResultAnewAndHealsAllWhoShareIt) {
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
  Reopen();
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, used);
}

TEST_F(DurableResultsTest, KnowsNoVolumeWhoseFileIsGone) {
  const std::string volume = Upload("clinic", "volume");
  const std::string digest = Sha256Of("volume").Hex();
  EXPECT_THAT(*Find("clinic", digest), SizeIs(1));
  std::filesystem::remove(FilesIn("blobs").at(0));
  EXPECT_THAT(*Find("clinic", digest), IsEmpty());
  EXPECT_EQ(ReasonOf(Create("clinic", JobOf(volume)).status()), Reason::kVolumeMissing);
  EXPECT_EQ(Upload("clinic", "volume"), volume);
  EXPECT_THAT(*Find("clinic", digest), SizeIs(1));
}

TEST_F(DurableResultsTest, LetsNothingExpireByAClockThatHasLeapt) {
  Close();
  options_.max_clock_leap = std::chrono::hours(24);
  Open();
  const std::string job = EndedJob();
  Close();
  Wait(std::chrono::hours(24 * 365));
  Open();
  EXPECT_TRUE(GetJob("clinic", job).ok()) << "the clock was wrong when the server started";
  Reopen();
  EXPECT_TRUE(GetJob("clinic", job).ok()) << "another start does not make it right";
  Wait(-std::chrono::hours(24 * 365));
  Reopen();
  EXPECT_EQ(GetJob("clinic", job)->state, JobState::kSucceeded);
  EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4));
}

TEST_F(DurableResultsTest, CleansUpAgainAfterAReadingFarAhead) {
  std::atomic<int> doubts = 0;
  Close();
  options_.max_clock_leap = std::chrono::hours(24);
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

TEST_F(DurableResultsTest, FailsAJobWhoseResultDoesNotFitOnTheDisk) {
  Close();
  options_.max_disk_bytes = 20;
  Open();
  const std::string job = MakeJob();
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kResourceExhausted);
  EXPECT_THAT(FilesIn("results"), IsEmpty());
  EXPECT_EQ(durable_jobs_->usage().disk_bytes, 6u);
}

TEST_F(DurableResultsTest, ForgetsResultsAfterTheirTime) {
  const std::string job = EndedJob();
  Wait(options_.keep_results + std::chrono::seconds(10));
  Reopen();
  EXPECT_EQ(GetJob("clinic", job).status().code(), absl::StatusCode::kNotFound);
  EXPECT_THAT(FilesIn("results"), IsEmpty());
}

}  // namespace
}  // namespace bccskel::server
