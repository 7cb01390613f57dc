#include "client/cli/file_writers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>

namespace bccskel::cli {
namespace {

TEST(FileWriters, RunEveryTaskBeforeTheyFinish) {
  std::atomic<int> runs = 0;
  FileWriters writers;
  for (int n = 0; n < 1000; ++n) {
    ASSERT_TRUE(writers.Add([&] { return ++runs, absl::OkStatus(); }).ok());
  }
  EXPECT_TRUE(writers.Finish().ok());
  EXPECT_EQ(runs, 1000);
}

TEST(FileWriters, RunSeveralTasksAtATime) {
  std::atomic<int> running = 0;
  FileWriters writers;
  for (int n = 0; n < 2; ++n) {
    ASSERT_TRUE(writers
                    .Add([&] {
                      ++running;
                      while (running < 2) std::this_thread::yield();  // for the other one
                      return absl::OkStatus();
                    })
                    .ok());
  }
  EXPECT_TRUE(writers.Finish().ok());
}

TEST(FileWriters, HaveNoMoreThreadsThanWanted) {
  std::atomic<bool> all_added = false;
  std::mutex mutex;
  std::set<std::thread::id> threads;
  FileWriters writers(2);
  for (int n = 0; n < 20; ++n) {
    const absl::Status added = writers.Add([&] {
      while (!all_added) std::this_thread::yield();  // so that no thread takes them all
      const std::lock_guard lock(mutex);
      threads.insert(std::this_thread::get_id());
      return absl::OkStatus();
    });
    EXPECT_TRUE(added.ok());
  }
  all_added = true;
  EXPECT_TRUE(writers.Finish().ok());
  EXPECT_LE(threads.size(), 2u);
}

TEST(FileWriters, ReportTheFirstErrorAndDropWhatFollows) {
  std::atomic<int> runs = 0;
  FileWriters writers;
  writers.Add([] { return absl::NotFoundError("first"); }).IgnoreError();
  while (writers.Add([] { return absl::OkStatus(); }).ok()) std::this_thread::yield();
  EXPECT_EQ(writers.Add([&] { return ++runs, absl::OkStatus(); }).message(), "first");
  EXPECT_EQ(writers.Finish().message(), "first");
  EXPECT_EQ(runs, 0);
}

}  // namespace
}  // namespace bccskel::cli
