#include "server/jobs/compute_queue.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <latch>
#include <semaphore>
#include <string>
#include <thread>
#include <vector>

namespace bccskel::server {
namespace {

using Usage = ComputeQueue::Usage;

ComputeQueue::Claim Claim(int most_threads) { return {.origin = {}, .most_threads = most_threads}; }

void WaitForUsage(const ComputeQueue& queue, const Usage& usage) {
  while (queue.usage() != usage) std::this_thread::yield();
}

TEST(ComputeQueue, JobsAreNicerThanOtherThreads) {
  constexpr int kNicest = 19;
  int niceness = 0;
  {
    ComputeQueue queue(1, 1);
    std::binary_semaphore done(0);
    queue.Post(Claim(1), [&](ComputeQueue::Turn&) {
      niceness = getpriority(PRIO_PROCESS, 0);
      done.release();
    });
    done.acquire();
  }
  const int here = getpriority(PRIO_PROCESS, 0);
  EXPECT_TRUE(niceness > here || niceness == kNicest) << niceness << " and " << here;
}

TEST(ComputeQueue, ALargeJobAloneGetsAllThreads) {
  ComputeQueue queue(8, 4);
  std::binary_semaphore done(0);
  int given = 0;
  queue.Post(Claim(100), [&](ComputeQueue::Turn& turn) {
    given = turn.threads();
    done.release();
  });
  done.acquire();
  EXPECT_EQ(given, 8);
  WaitForUsage(queue, Usage());
}

TEST(ComputeQueue, JobsAfterEachOtherShareTheirThreads) {
  ComputeQueue queue(2, 1);
  std::vector<std::thread::id> helpers(3);
  for (std::thread::id& helper : helpers) {
    queue.Post(Claim(2), [&helper](ComputeQueue::Turn& turn) {
      turn.team().Run([&helper](int worker) {
        if (worker == 1) helper = std::this_thread::get_id();
      });
    });
    WaitForUsage(queue, Usage());
  }
  EXPECT_NE(helpers[0], std::thread::id());
  EXPECT_EQ(helpers, std::vector(3, helpers[0]));
}

TEST(ComputeQueue, SmallJobsRunSideBySide) {
  ComputeQueue queue(3, 3);
  std::latch together(3);
  std::atomic<int> threads_given = 0;
  for (int n = 0; n < 3; ++n) {
    queue.Post(Claim(1), [&](ComputeQueue::Turn& turn) {
      threads_given += turn.threads();
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
  queue.Post(Claim(1), [&](ComputeQueue::Turn&) { small_may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 1});
  int given = 0;
  queue.Post(Claim(4), [&](ComputeQueue::Turn& turn) {
    given = turn.threads();
    large_done.release();
  });
  large_done.acquire();
  EXPECT_EQ(given, 3);
  small_may_end.release();
}

TEST(ComputeQueue, NeverRunsMoreJobsThanAllowed) {
  ComputeQueue queue(4, 2);
  std::counting_semaphore<8> may_end(0);
  for (int n = 0; n < 5; ++n) queue.Post(Claim(1), [&](ComputeQueue::Turn&) { may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 3, .running = 2, .busy_threads = 2});
  may_end.release(5);
  WaitForUsage(queue, Usage());
}

TEST(ComputeQueue, FirstComeFirstServed) {
  ComputeQueue queue(1, 1);
  std::binary_semaphore may_begin(0);
  std::vector<int> order;
  std::latch done(10);
  queue.Post(Claim(1), [&](ComputeQueue::Turn&) { may_begin.acquire(); });
  for (int n = 0; n < 10; ++n) {
    queue.Post(Claim(1), [&, n](ComputeQueue::Turn&) {
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
  const auto first = queue.Post(Claim(1), [&](ComputeQueue::Turn&) { may_end.acquire(); });
  WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 1});
  const auto second = queue.Post(Claim(1), [&](ComputeQueue::Turn&) { second_ran = true; });
  EXPECT_TRUE(queue.Remove(second));
  EXPECT_FALSE(queue.Remove(second));
  EXPECT_FALSE(queue.Remove(first));
  may_end.release();
  WaitForUsage(queue, Usage());
  EXPECT_FALSE(second_ran);
}

TEST(ComputeQueue, ALargeJobStartsBesideOneThatHasAllThreads) {
  ComputeQueue queue(2, 2);
  std::latch together(2);
  std::atomic<int> first = 0, second = 0;
  queue.Post(Claim(2), [&](ComputeQueue::Turn& turn) {
    first = turn.threads();
    together.arrive_and_wait();  // hangs unless both run at the same time
  });
  WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 2});
  queue.Post(Claim(2), [&](ComputeQueue::Turn& turn) {
    second = turn.threads();
    together.arrive_and_wait();
  });
  WaitForUsage(queue, Usage());
  EXPECT_EQ(first, 2);
  EXPECT_EQ(second, 1);
}

TEST(ComputeQueue, AJobLeavesThreadsToThoseThatComeLaterAndTakesThemBack) {
  ComputeQueue queue(4, 4);
  std::binary_semaphore may_end(0);
  queue.Post(Claim(4), [&](ComputeQueue::Turn& turn) {
    EXPECT_EQ(turn.share(), 4);
    std::latch both(2), seen(1);
    queue.Post(Claim(4), [&](ComputeQueue::Turn& later) {
      EXPECT_EQ(later.share(), 1);
      both.count_down();
      seen.wait();
    });
    both.arrive_and_wait();
    EXPECT_EQ(turn.share(), 3);
    seen.count_down();
    WaitForUsage(queue, {.waiting = 0, .running = 1, .busy_threads = 4});
    EXPECT_EQ(turn.share(), 4);
    may_end.release();
  });
  may_end.acquire();
  WaitForUsage(queue, Usage());
}

TEST(ComputeQueue, LargeJobsThatCameTogetherLatelyTakeOneThreadEach) {
  std::atomic<int> now_ms = 0;
  ComputeQueue queue(
      2, 2, {}, [&] { return ComputeQueue::Clock::time_point(std::chrono::milliseconds(now_ms)); });
  std::atomic<int> given = 0;
  const auto run_alone = [&] {
    queue.Post(Claim(2), [&](ComputeQueue::Turn& turn) { given = turn.threads(); });
    WaitForUsage(queue, Usage());
    return given.load();
  };
  EXPECT_EQ(run_alone(), 2);
  std::latch together(2);
  for (int n = 0; n < 2; ++n) {
    queue.Post(Claim(2), [&](ComputeQueue::Turn&) { together.arrive_and_wait(); });
  }
  WaitForUsage(queue, Usage());
  EXPECT_EQ(run_alone(), 1);  // the other caller may be back at once
  now_ms += 1000;
  EXPECT_EQ(run_alone(), 2);
}

// A queue of one thread whose clock is moved by hand, and a large job that is at work.
class GivingWay : public testing::Test {
 protected:
  using Turn = ComputeQueue::Turn;
  static constexpr uint64_t kLargeBricks = 8000;

  // Runs `large` and returns once everything is done.
  void RunLarge(const std::function<void(Turn&)>& large) {
    queue_.Post({.origin = {}, .most_threads = 1, .bricks = kLargeBricks}, large);
    while (queue_.usage() != Usage()) std::this_thread::yield();
  }
  void PostSmall(const std::string& name, uint64_t bricks = kLargeBricks / 2, int most_threads = 1,
                 const std::string& tenant = "") {
    JobOrigin origin;
    origin.tenant = tenant;
    queue_.Post({.origin = origin, .most_threads = most_threads, .bricks = bricks},
                [=, this](Turn&) {
                  order_ += name;
                  now_ms_ += kSmallMs;
                });
  }

  static constexpr int kSmallMs = 10;
  std::atomic<int> now_ms_ = 0;
  std::string order_;
  ComputeQueue queue_{1, 1, {}, [this] {
                        return ComputeQueue::Clock::time_point(std::chrono::milliseconds(now_ms_));
                      }};
};

TEST_F(GivingWay, ASmallJobRunsWhileALargeOneRests) {
  RunLarge([this](Turn& turn) {
    PostSmall("s");
    order_ += "(";
    turn.Yield();
    order_ += ")";
  });
  EXPECT_EQ(order_, "(s)");
}

TEST_F(GivingWay, AfterwardsTheLargeOneHasAsMuchTime) {
  RunLarge([this](Turn& turn) {
    PostSmall("s");
    PostSmall("t");
    turn.Yield();
    turn.Yield();
    now_ms_ += kSmallMs - 1;
    turn.Yield();
    order_ += "|";
    now_ms_ += 1;
    turn.Yield();
    order_ += "|";
  });
  EXPECT_EQ(order_, "s|t|");
}

TEST_F(GivingWay, NoTenantWaitsForWhatAnotherHasTaken) {
  RunLarge([this](Turn& turn) {
    for (const char* name : {"a", "a"}) PostSmall(name, 1, 1, "greedy");
    turn.Yield();
    for (const char* name : {"b", "b"}) PostSmall(name, 1, 1, "clinic");
    turn.Yield();
    turn.Yield();
    order_ += "|";
  });
  EXPECT_EQ(order_.substr(0, 3), "ab|");
}

TEST_F(GivingWay, OnlyToJobsThatAreMuchSmallerAndTakeOneThread) {
  RunLarge([this](Turn& turn) {
    PostSmall("a", kLargeBricks / 2 + 1);
    PostSmall("b", 1, 2);
    turn.Yield();
    order_ += "|";
  });
  EXPECT_EQ(order_, "|ab");
}

TEST_F(GivingWay, ToSmallJobsThatComeAfterOthersWereTooLarge) {
  RunLarge([this](Turn& turn) {
    PostSmall("l", kLargeBricks);
    turn.Yield();
    PostSmall("s");
    turn.Yield();
    order_ += "|";
    now_ms_ += kSmallMs;
    turn.Yield();  // nobody is left, which is noticed here
    PostSmall("t");
    turn.Yield();
    order_ += "|";
  });
  EXPECT_EQ(order_, "s|t|l");
}

TEST_F(GivingWay, OnlyOnTheThreadOfTheJob) {
  RunLarge([this](Turn& turn) {
    PostSmall("s");
    std::jthread([&turn] { turn.Yield(); }).join();
    order_ += "|";
  });
  EXPECT_EQ(order_, "|s");
}

}  // namespace
}  // namespace bccskel::server
