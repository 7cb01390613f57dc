#include "server/jobs/compute_queue.h"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <semaphore>
#include <thread>
#include <vector>

namespace bccskel::server {
namespace {

using Usage = ComputeQueue::Usage;

void WaitForUsage(const ComputeQueue& queue, const Usage& usage) {
  while (queue.usage() != usage) std::this_thread::yield();
}

TEST(ComputeQueue, ALargeJobAloneGetsAllThreads) {
  ComputeQueue queue(8, 4);
  std::binary_semaphore done(0);
  int given = 0;
  queue.Post(100, [&](int threads) {
    given = threads;
    done.release();
  });
  done.acquire();
  EXPECT_EQ(given, 8);
  WaitForUsage(queue, Usage());
}

TEST(ComputeQueue, SmallJobsRunSideBySide) {
  ComputeQueue queue(3, 3);
  std::latch together(3);
  std::atomic<int> threads_given = 0;
  for (int n = 0; n < 3; ++n) {
    queue.Post(1, [&](int threads) {
      threads_given += threads;
      together.arrive_and_wait();  // hangs unless all three run at the same time
    });
  }
  together.wait();
  WaitForUsage(queue, Usage());
  EXPECT_EQ(threads_given, 3);
}

TEST(ComputeQueue, ALargeJobTakesTheThreadsThatAreFree) {
  ComputeQueue queue(4, 4);
  std::binary_semaphore small_may_end(0), large_done(0);
  queue.Post(1, [&](int) { small_may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 1});
  int given = 0;
  queue.Post(4, [&](int threads) {
    given = threads;
    large_done.release();
  });
  large_done.acquire();
  EXPECT_EQ(given, 3);
  small_may_end.release();
}

TEST(ComputeQueue, NeverRunsMoreJobsThanAllowed) {
  ComputeQueue queue(4, 2);
  std::counting_semaphore<8> may_end(0);
  for (int n = 0; n < 5; ++n) queue.Post(1, [&](int) { may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 3, .running = 2, .busy_threads = 2});
  may_end.release(5);
  WaitForUsage(queue, Usage());
}

TEST(ComputeQueue, FirstComeFirstServed) {
  ComputeQueue queue(1, 1);
  std::binary_semaphore may_begin(0);
  std::vector<int> order;
  std::latch done(10);
  queue.Post(1, [&](int) { may_begin.acquire(); });
  for (int n = 0; n < 10; ++n) {
    queue.Post(1, [&, n](int) {
      order.push_back(n);
      done.count_down();
    });
  }
  may_begin.release();
  done.wait();
  EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9}));
}

TEST(ComputeQueue, WaitingWorkCanBeRemovedAndRunningWorkCannot) {
  ComputeQueue queue(1, 1);
  std::binary_semaphore may_end(0);
  std::atomic<bool> second_ran = false;
  const auto first = queue.Post(1, [&](int) { may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 1});
  const auto second = queue.Post(1, [&](int) { second_ran = true; });
  EXPECT_EQ(queue.Remove(second), ComputeQueue::Removal::kRemoved);
  EXPECT_EQ(queue.Remove(second), ComputeQueue::Removal::kNotWaiting);
  EXPECT_EQ(queue.Remove(first), ComputeQueue::Removal::kNotWaiting);
  may_end.release();
  WaitForUsage(queue, Usage());
  EXPECT_FALSE(second_ran);
}

}  // namespace
}  // namespace bccskel::server
