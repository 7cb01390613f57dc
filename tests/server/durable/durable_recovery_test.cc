#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <random>
#include <set>
#include <string>
#include <vector>

#include "server/errors/call_error.h"
#include "tests/server/durable/durable_fixture.h"

namespace bccskel::server {
namespace {

using testing::HasSubstr, testing::SizeIs;

class DurableRecoveryTest : public DurableTest {
 protected:
  void SetUp() override { Open(); }

  // A kill is no different from a crash: a job that was at work at three of them has had its turns.
  void ExpectResult(const JobInfo& job) {
    if (job.state == JobState::kFailed && ReasonOf(job.error).has_value()) {
      EXPECT_EQ(ReasonOf(job.error), Reason::kPoisoned);
      EXPECT_GE(job.attempts, 3);
      return;
    }
    EXPECT_EQ(job.state, JobState::kSucceeded) << job.error;
    const auto records = ReadResult("clinic", job.name);
    ASSERT_TRUE(records.ok()) << records.status();
    EXPECT_THAT(*records, SizeIs(4));
  }
};

TEST_F(DurableRecoveryTest, RunsWhatWaitedAndWhatRanAgain) {
  Close();
  options_.max_runs = 1;
  Open();
  runner_->Hold();
  const std::string runs = MakeJob("one");
  runner_->WaitForComputing(1);
  const std::string waits = MakeJob("two");
  Crash();
  Open();
  const JobInfo again = WaitForEnd("clinic", runs);
  EXPECT_EQ(again.state, JobState::kSucceeded) << again.error;
  EXPECT_EQ(again.attempts, 2);
  EXPECT_EQ(WaitForEnd("clinic", waits).attempts, 1);
  EXPECT_THAT(FilesIn("results"), SizeIs(2));
}

TEST_F(DurableRecoveryTest, GoesOnWithTheNumbersOfEvents) {
  runner_->Hold();
  const std::string job = MakeJob();
  auto before = std::make_shared<RememberingWatcher>();
  auto handle = durable_jobs_->WatchJob("clinic", job, 0, before);
  runner_->WaitForComputing(1);
  WaitForState("clinic", job, JobState::kRunning);
  Crash();
  const uint64_t last = before->events().back().sequence;
  Open();
  const auto after = WatchToTheEnd("clinic", job, last);
  EXPECT_EQ(after->States(), "123") << "waits again, runs, has succeeded";
  for (const JobEvent& event : after->events()) EXPECT_GT(event.sequence, last);
  EXPECT_EQ(WatchToTheEnd("clinic", job)->States(), "12123");
  handle.reset();
}

TEST_F(DurableRecoveryTest, DoesNotRunAJobAFourthTimeThatWasThereAtThreeCrashes) {
  std::string job;
  runner_->Hold();
  for (int attempt = 1; attempt <= 3; ++attempt) {
    if (attempt == 1) job = MakeJob();
    runner_->WaitForComputing(1);
    EXPECT_EQ(GetJob("clinic", job)->attempts, attempt) << "counted before it begins";
    Crash();
    if (attempt < 3) runner_->Hold();
    Open();
  }
  const JobInfo ended = WaitForEnd("clinic", job);
  EXPECT_EQ(ended.state, JobState::kFailed);
  EXPECT_EQ(ended.error.code(), absl::StatusCode::kInternal);
  EXPECT_EQ(ReasonOf(ended.error), Reason::kPoisoned);
  EXPECT_EQ(runner_->started(), 0);
}

TEST_F(DurableRecoveryTest, CountsNoCrashWhenTheServerStopsInGoodOrder) {
  std::string job = MakeJob("first");
  WaitForEnd("clinic", job);
  runner_->Hold();
  job = MakeJob();
  for (int stop = 0; stop < 4; ++stop) {
    WaitForState("clinic", job, JobState::kRunning);
    runner_->WaitForComputing(stop + 2);
    Reopen();
  }
  runner_->Release();
  EXPECT_EQ(WaitForEnd("clinic", job).state, JobState::kSucceeded);
}

TEST_F(DurableRecoveryTest, FailsTheJobOfADamagedVolumeAndRunsTheOthers) {
  runner_->Hold();
  const std::string volume = Upload("clinic", "one");
  const std::string damaged = CreateName("clinic", JobOf(volume));
  const std::string other = MakeJob("two");
  Close();
  {
    auto tables = OpenSqlite(options_.data_directory + "/jobs.db");
    ASSERT_TRUE(tables.ok()) << tables.status();
    const auto changed = (*tables)->Run(
        "UPDATE volumes SET size_bytes = size_bytes + 1 WHERE name = $1", {SqlValue::Text(volume)});
    ASSERT_TRUE(changed.ok()) << changed.status();
  }
  Open();
  runner_->Release();
  EXPECT_EQ(WaitForEnd("clinic", damaged).error.code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(WaitForEnd("clinic", other).state, JobState::kSucceeded);
}

class DurableFilesTest : public DurableRecoveryTest {
 protected:
  void SetUp() override {
    DurableRecoveryTest::SetUp();
    job_ = EndedJob();
    Close();
  }
  std::string Path(const std::string& name) const { return options_.data_directory + "/" + name; }
  void MakeOld(const std::string& file) const {
    std::filesystem::last_write_time(
        file, std::filesystem::file_time_type::clock::now() - std::chrono::hours(25));
  }
  void ExpectRefusal() {
    const absl::Status refused = TryOpen();
    EXPECT_EQ(refused.code(), absl::StatusCode::kFailedPrecondition) << refused;
    EXPECT_THAT(std::string(refused.message()), HasSubstr("--unknown-data adopt"));
    EXPECT_THAT(FilesIn("results"), SizeIs(1));
    EXPECT_THAT(FilesIn("blobs"), SizeIs(1));
  }

  std::string job_;
};

TEST_F(DurableFilesTest, SweepsOldFilesThatNobodyKnows) {
  for (const std::string& known : {FilesIn("results")[0], FilesIn("blobs")[0]}) {
    for (const char* suffix : {"0", "1"}) std::filesystem::copy(known, known + suffix);
    MakeOld(known + "0");
  }
  Open();
  EXPECT_THAT(FilesIn("results"), SizeIs(2)) << "what is young may be missed yet";
  EXPECT_THAT(FilesIn("blobs"), SizeIs(2));
  EXPECT_THAT(*ReadResult("clinic", job_), SizeIs(4));
}

TEST_F(DurableFilesTest, TakesAResultThatACrashHasLeftBeforeItsNameOrBeforeItsRow) {
  const std::string file = FilesIn("results")[0];
  std::filesystem::rename(file, file + ".new");
  std::filesystem::copy(file + ".new", file + "0.new");
  Open();
  EXPECT_EQ(FilesIn("results"), std::vector<std::string>{file});
  EXPECT_THAT(*ReadResult("clinic", job_), SizeIs(4));
}

TEST_F(DurableFilesTest, SweepsNothingWhileAFileIsMissedUnderItsName) {
  const std::string file = FilesIn("results")[0];
  std::string other = file;
  other.back() = other.back() == 'a' ? 'c' : 'a';  // a bit of the file's name
  std::filesystem::rename(file, other);
  MakeOld(other);
  Open();
  EXPECT_TRUE(std::filesystem::exists(other));
  EXPECT_EQ(ReadResult("clinic", job_).status().code(), absl::StatusCode::kDataLoss);
}

TEST_F(DurableFilesTest, DoesNotStartWithoutTheTablesOfItsFiles) {
  for (const char* file : {"jobs.db", "lock"}) {
    std::filesystem::remove(Path(file));
    ExpectRefusal();
    std::ofstream(Path("jobs.db")).close();
    ExpectRefusal();
  }
}

TEST_F(DurableFilesTest, DoesNotStartAfterACrashWithoutTheLogOfItsTables) {
  Open();
  const std::string job = MakeJob();
  Crash();
  std::filesystem::rename(Path("jobs.db-wal"), Path("moved"));
  ExpectRefusal();
  EXPECT_FALSE(std::filesystem::exists(Path("jobs.db-wal"))) << "the next start must refuse, too";
  std::filesystem::rename(Path("moved"), Path("jobs.db-wal"));
  Open();
  EXPECT_TRUE(GetJob("clinic", job).ok());
  Crash();
  std::filesystem::remove(Path("jobs.db-wal"));
  options_.unknown_data = "adopt";
  Open();
  EXPECT_TRUE(GetJob("clinic", job_).ok());
}

TEST_F(DurableFilesTest, ConfirmsNothingWhileTheLogOfItsTablesIsGone) {
  Open();
  const std::string confirmed = MakeJob();
  std::filesystem::remove(Path("jobs.db-wal"));
  EXPECT_EQ(durable_jobs_->Health().code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(GetJob("clinic", confirmed).status().code(), absl::StatusCode::kDataLoss);
  Close();  // saves what the removed file holds
  Open();
  EXPECT_TRUE(GetJob("clinic", confirmed).ok());
}

TEST_F(DurableFilesTest, DoesNotStartWithTheTablesOfAnotherFolder) {
  const std::string own = options_.data_directory;
  options_.data_directory = folder_ / "other";
  Open();
  WaitForEnd("clinic", MakeJob("another"));
  Close();
  options_.data_directory = own;
  const auto over = std::filesystem::copy_options::overwrite_existing;
  std::filesystem::copy(Path("jobs.db"), Path("saved"));
  std::filesystem::copy(folder_ / "other/jobs.db", Path("jobs.db"), over);
  ExpectRefusal();
  std::filesystem::remove(Path("lock"));  // which names the store
  ExpectRefusal();
  std::filesystem::copy(Path("saved"), Path("jobs.db"), over);
  Open();
  EXPECT_THAT(*ReadResult("clinic", job_), SizeIs(4));
}

TEST_F(DurableFilesTest, GoesOnWithoutTheTablesWhereItIsTold) {
  std::filesystem::remove(Path("jobs.db"));
  MakeOld(FilesIn("results")[0]);
  options_.unknown_data = "adopt";
  Open();
  EXPECT_THAT(FilesIn("results"), SizeIs(1));
  const std::string job = MakeJob();
  EXPECT_EQ(WaitForEnd("clinic", job).state, JobState::kSucceeded);
  Close();
  options_.unknown_data = "refuse";
  Open();
  EXPECT_THAT(FilesIn("results"), SizeIs(1)) << "the old one is swept at the next start";
  EXPECT_THAT(*ReadResult("clinic", job), SizeIs(4));
}

TEST_F(DurableFilesTest, TellsWhenItsTablesAreGone) {
  Open();
  EXPECT_TRUE(durable_jobs_->Health().ok());
  std::filesystem::rename(Path("jobs.db"), Path("moved"));
  EXPECT_EQ(durable_jobs_->Health().code(), absl::StatusCode::kDataLoss);
  EXPECT_EQ(GetJob("clinic", job_).status().code(), absl::StatusCode::kDataLoss);
  std::filesystem::rename(Path("moved"), Path("jobs.db"));
  EXPECT_TRUE(GetJob("clinic", job_).ok());
  EXPECT_TRUE(durable_jobs_->Health().ok());
}

TEST_F(DurableFilesTest, LearnsWithoutACallThatItsTablesAreBack) {
  Open();
  std::filesystem::rename(Path("jobs.db"), Path("moved"));
  EXPECT_FALSE(GetJob("clinic", job_).ok());
  std::filesystem::rename(Path("moved"), Path("jobs.db"));
  while (!durable_jobs_->Health().ok()) durable_jobs_->Probe();
}

// A server that is killed at any moment, and what it has confirmed until then.
class KilledServer {
 public:
  explicit KilledServer(const DurableOptions& options) : options_(options) {}

  // Makes jobs until it is killed; yields the request ids that were confirmed.
  std::set<std::string> Run(int round, int microseconds) {
    int pipes[2] = {};
    EXPECT_EQ(pipe(pipes), 0);
    const pid_t child = fork();
    if (child == 0) Serve(round, pipes[1]);
    close(pipes[1]);
    std::set<std::string> confirmed;
    uint32_t n = 0;
    // Every second server lives long enough to confirm something, however slow the machine is.
    if (round % 2 == 0 && read(pipes[0], &n, sizeof(n)) == sizeof(n)) {
      confirmed.insert(RequestOf(round, n));
    }
    usleep(static_cast<useconds_t>(microseconds));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    while (read(pipes[0], &n, sizeof(n)) == sizeof(n)) confirmed.insert(RequestOf(round, n));
    close(pipes[0]);
    return confirmed;
  }

 private:
  static std::string RequestOf(int round, uint32_t n) {
    return std::to_string(round) + "-" + std::to_string(n);
  }

  [[noreturn]] void Serve(int round, int pipe) {
    FakeRunner runner;
    const FakeCodec codec;
    const auto opened = DurableJobs::Open(options_, runner, codec);
    if (!opened.ok()) _exit(1);
    DurableJobs& durable_jobs = **opened;
    for (uint32_t n = 0;; ++n) {
      const std::string bytes = "volume " + std::to_string(n % 8);
      const std::string upload = "uploads/" + RequestOf(round, n);
      durable_jobs.CreateUpload("clinic",
                                {.name = upload, .declaration = std::to_string(bytes.size())},
                                [&durable_jobs, pipe, round, n, upload, bytes](const auto& begun) {
                                  if (begun.ok()) Send(durable_jobs, pipe, round, n, upload, bytes);
                                });
      usleep(500);
    }
  }

  static void Send(DurableJobs& durable_jobs, int pipe, int round, uint32_t n,
                   const std::string& upload, const std::string& bytes) {
    durable_jobs.Append("clinic", upload, 0, bytes, std::nullopt, [=, &durable_jobs](const auto&) {
      durable_jobs.FinishUpload("clinic", upload, bytes.size(), std::nullopt,
                                [=, &durable_jobs](auto volume) {
                                  if (!volume.ok()) return;
                                  NewJob job;
                                  job.request_id = RequestOf(round, n);
                                  job.volume = volume->name;
                                  job.options = std::to_string(n);
                                  durable_jobs.CreateJob("clinic", job, [=](const auto& created) {
                                    if (created.ok()) (void)!write(pipe, &n, sizeof(n));
                                  });
                                });
    });
  }

  const DurableOptions options_;
};

TEST_F(DurableRecoveryTest, LosesAndDoublesNothingHoweverOftenItIsKilled) {
  Close();
  options_.now = [] { return std::chrono::system_clock::now(); };
  runner_.reset();  // no threads while processes fork
  std::mt19937 random(20061121);
  std::set<std::string> confirmed;
  for (int round = 0; round < 20; ++round) {
    confirmed.merge(KilledServer(options_).Run(round, 5'000 + static_cast<int>(random() % 80'000)));
  }
  EXPECT_GT(confirmed.size(), 0u) << "no round lived long enough";
  runner_ = std::make_unique<FakeRunner>();
  Open();
  JobQuery query;
  query.page_size = 1000;
  std::set<std::string> found;
  do {
    const auto page = List("clinic", query);
    ASSERT_TRUE(page.ok()) << page.status();
    for (const JobInfo& job : page->jobs) {
      EXPECT_TRUE(found.insert(job.request_id).second) << job.request_id << " twice";
      ExpectResult(WaitForEnd("clinic", job.name));
    }
    query.page_token = page->next_token;
  } while (!query.page_token.empty());
  EXPECT_TRUE(std::includes(found.begin(), found.end(), confirmed.begin(), confirmed.end()));
}

}  // namespace
}  // namespace bccskel::server
