#include "server/store/group_commit.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <future>
#include <string>
#include <thread>
#include <vector>

#include "server/store/job_store.h"
#include "tests/support/temporary_folder.h"

namespace bccskel::server {
namespace {

JobRow Job(const std::string& name) {
  JobRow job;
  job.tenant = "clinic";
  job.name = name;
  return job;
}

std::unique_ptr<JobStore> Open(const test::TemporaryFolder& folder) {
  auto store = OpenSqliteJobStore(folder / "jobs.db");
  EXPECT_TRUE(store.ok()) << store.status();
  return *std::move(store);
}

GroupCommit::Change Insert(const std::string& name) {
  return [name](JobStore& store) { return store.InsertJob(Job(name)).status(); };
}

TEST(GroupCommitTest, WritesWhatWaitsInOneTransaction) {
  const test::TemporaryFolder folder;
  std::promise<void> go;
  std::vector<int> order;
  int transactions = 0;
  {
    GroupCommit commit(Open(folder));
    commit.OnBegin([&] { ++transactions; });
    commit.Post([&] { go.get_future().wait(); });
    for (int n = 0; n < 100; ++n) {
      commit.Post(Insert("jobs/" + std::to_string(n)), [&order, n](const absl::Status& status) {
        EXPECT_TRUE(status.ok()) << status;
        order.push_back(n);
      });
    }
    go.set_value();
    std::promise<void> done;
    commit.Post([&] { done.set_value(); });
    done.get_future().wait();
    EXPECT_LE(transactions, 2);
  }
  ASSERT_EQ(order.size(), 100u);
  EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
  EXPECT_EQ(Open(folder)->UnfinishedJobs()->size(), 100u);
}

TEST(GroupCommitTest, AChangeThatFailsTakesBackNothingButItself) {
  const test::TemporaryFolder folder;
  absl::Status failed;
  {
    GroupCommit commit(Open(folder));
    commit.Post(Insert("jobs/before"), nullptr);
    commit.Post(
        [](JobStore& store) -> absl::Status {
          EXPECT_TRUE(store.InsertJob(Job("jobs/failed")).ok());
          return absl::AbortedError("no");
        },
        [&](const absl::Status& status) { failed = status; });
    commit.Post(Insert("jobs/after"), nullptr);
  }
  EXPECT_EQ(failed.code(), absl::StatusCode::kAborted);
  const auto store = Open(folder);
  EXPECT_TRUE(store->Find<JobRow>("clinic", "jobs/before")->has_value());
  EXPECT_FALSE(store->Find<JobRow>("clinic", "jobs/failed")->has_value());
  EXPECT_TRUE(store->Find<JobRow>("clinic", "jobs/after")->has_value());
}

TEST(GroupCommitTest, AChangeThatFindsNothingCostsNoFurtherTransaction) {
  const test::TemporaryFolder folder;
  int transactions = 0;
  GroupCommit commit(Open(folder));
  commit.OnBegin([&] { ++transactions; });
  std::promise<void> go;
  commit.Post([&] { go.get_future().wait(); });
  absl::Status failed;
  commit.Post(Insert("jobs/before"), nullptr);
  commit.Post(
      [](JobStore& store) -> absl::Status {
        EXPECT_TRUE((*store.Find<JobRow>("clinic", "jobs/before")).has_value());
        return absl::NotFoundError("no");
      },
      [&](const absl::Status& status) { failed = status; });
  std::promise<void> done;
  commit.Post([&] { done.set_value(); });
  go.set_value();
  done.get_future().wait();
  EXPECT_EQ(failed.code(), absl::StatusCode::kNotFound);
  EXPECT_EQ(transactions, 1);
}

// While it lives, files end at `bytes`.
class LimitedFiles {
 public:
  explicit LimitedFiles(uint64_t bytes) {
    std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limited = {.rlim_cur = bytes, .rlim_max = before_.rlim_max};
    setrlimit(RLIMIT_FSIZE, &limited);
  }
  ~LimitedFiles() { setrlimit(RLIMIT_FSIZE, &before_); }

 private:
  rlimit before_ = {};
};

// A tenant whose job does not fit on the disk must not be another's error, let alone a reader's.
TEST(GroupCommitTest, ATransactionThatFailsIsTheErrorOfNoOtherChange) {
  const test::TemporaryFolder folder;
  GroupCommit commit(Open(folder));
  std::promise<void> go;
  commit.Post([&] { go.get_future().wait(); });
  JobRow large = Job("jobs/large");
  large.options.assign(1 << 20, 'x');
  std::vector<absl::StatusCode> codes;
  const auto remember = [&](const absl::Status& status) { codes.push_back(status.code()); };
  std::string read;
  commit.Post(Insert("jobs/before"), remember);
  commit.Post([&](JobStore& store) { return store.InsertJob(large).status(); }, remember);
  commit.Post(
      [&](JobStore& store) -> absl::Status {
        read = (*store.Find<JobRow>("clinic", "jobs/before"))->name;
        read +=
            (*store.Find<JobRow>("clinic", "jobs/large")).has_value() ? " and the large one" : "";
        return absl::OkStatus();
      },
      remember);
  commit.Post(Insert("jobs/after"), remember);
  std::promise<void> done;
  commit.Post([&] { done.set_value(); });
  {
    const LimitedFiles limited(512 << 10);
    go.set_value();
    done.get_future().wait();
  }
  using enum absl::StatusCode;
  EXPECT_EQ(codes, (std::vector{kOk, kResourceExhausted, kOk, kOk}));
  EXPECT_EQ(read, "jobs/before");
}

TEST(GroupCommitTest, TakesChangesFromManyThreads) {
  const test::TemporaryFolder folder;
  {
    GroupCommit commit(Open(folder));
    std::vector<std::jthread> threads;
    for (int thread = 0; thread < 4; ++thread) {
      threads.emplace_back([&commit, thread] {
        for (int n = 0; n < 50; ++n) {
          commit.Post(Insert(std::to_string(thread) + "/" + std::to_string(n)), nullptr);
        }
      });
    }
  }
  EXPECT_EQ(Open(folder)->UnfinishedJobs()->size(), 200u);
}

}  // namespace
}  // namespace bccskel::server
