#include "client/cli/file_writers.h"

#include <gtest/gtest.h>

#include <atomic>

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
