#include "client/cli/file_writers.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
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

TEST(FileWriters, RunNoMoreTasksAtATimeThanWanted) {
  std::atomic<int> running = 0, most = 0;
  FileWriters writers(2);
  for (int n = 0; n < 20; ++n) {
    const absl::Status added = writers.Add([&] {
      const int now = ++running;
      for (int before = most; now > before && !most.compare_exchange_weak(before, now);) {
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
      --running;
      return absl::OkStatus();
    });
    EXPECT_TRUE(added.ok());
  }
  EXPECT_TRUE(writers.Finish().ok());
  EXPECT_LE(most, 2);
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
