#include "server/jobs/task_threads.h"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

namespace bccskel::server {
namespace {

TEST(TaskThreads, OneThreadKeepsTheOrder) {
  std::vector<int> ran;
  {
    TaskThreads threads(1);
    for (int n = 0; n < 100; ++n) threads.Post({}, [&ran, n] { ran.push_back(n); });
  }
  ASSERT_EQ(ran.size(), 100u);
  for (int n = 0; n < 100; ++n) EXPECT_EQ(ran[static_cast<size_t>(n)], n);
}

TEST(TaskThreads, RunEverythingThatWasPostedBeforeTheyEnd) {
  std::atomic<int> ran = 0;
  {
    TaskThreads threads(3);
    for (int n = 0; n < 1000; ++n) threads.Post({}, [&ran] { ++ran; });
  }
  EXPECT_EQ(ran, 1000);
}

}  // namespace
}  // namespace bccskel::server
