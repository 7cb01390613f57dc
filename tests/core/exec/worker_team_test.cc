#include "core/exec/worker_team.h"

#include <gtest/gtest.h>
#if defined(__linux__)
#include <sched.h>
#endif

#include <algorithm>
#include <atomic>
#include <chrono>
#include <ctime>
#include <new>
#include <set>
#include <thread>
#include <vector>

namespace bccskel::exec {
namespace {

int MoreThanProcessors() { return 4 * static_cast<int>(std::thread::hardware_concurrency()) + 3; }

std::vector<int> TeamSizes() { return {1, 2, 3, 8, MoreThanProcessors()}; }

TEST(WorkerTeam, RunsTheWorkOnceForEveryWorkerTimeAfterTime) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    ASSERT_EQ(team.size(), size);
    std::vector<int> runs(static_cast<size_t>(size));  // plain integers: Run() orders the accesses
    constexpr int kRuns = 100;
    for (int n = 1; n <= kRuns; ++n) {
      team.Run([&](int worker) { ++runs[static_cast<size_t>(worker)]; });
      ASSERT_EQ(runs, std::vector<int>(runs.size(), n)) << size << " workers";
    }
  }
}

TEST(WorkerTeam, CallerIsWorkerZeroAndTheOthersHaveThreadsOfTheirOwn) {
  WorkerTeam team(4);
  std::vector<std::thread::id> ids(4);
  team.Run([&](int worker) { ids[static_cast<size_t>(worker)] = std::this_thread::get_id(); });
  EXPECT_EQ(ids[0], std::this_thread::get_id());
  EXPECT_EQ(std::set(ids.begin(), ids.end()).size(), 4u);
}

TEST(WorkerTeam, AllWorkersAreThereAtTheSameTime) {
  const int size = MoreThanProcessors();
  WorkerTeam team(size);
  std::atomic<int> present{0};
  team.Run([&](int) {
    ++present;
    while (present < size) std::this_thread::yield();
  });
  EXPECT_EQ(present, size);
}

TEST(WorkerTeam, EndsWithoutEverHavingRun) {
  for (int size : TeamSizes()) const WorkerTeam team(size);
}

TEST(WorkerTeam, RunsWorkOfALaterCallOnlyAfterTheEarlierCall) {
  WorkerTeam team(3);
  std::vector<int> order;
  for (int n = 0; n < 50; ++n) {
    team.Run([&](int worker) {
      if (worker == n % 3) order.push_back(n);
    });
  }
  for (int n = 0; n < 50; ++n) EXPECT_EQ(order[static_cast<size_t>(n)], n);
}

TEST(Barrier, LetsNobodyPassBeforeAllHaveCome) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    Barrier barrier(size);
    constexpr int kPhases = 60;
    std::vector<int> phase_of(static_cast<size_t>(size));  // guarded by the barrier alone
    std::atomic<int> early{0};
    team.Run([&](int worker) {
      for (int phase = 1; phase <= kPhases; ++phase) {
        phase_of[static_cast<size_t>(worker)] = phase;
        barrier.Wait(worker);
        for (int other : phase_of) early += other != phase ? 1 : 0;
        barrier.Wait(worker);
      }
    });
    EXPECT_EQ(early, 0) << size << " workers";
  }
}

TEST(Barrier, WaitsForAWorkerThatSleeps) {
  WorkerTeam team(2);
  Barrier barrier(2);
  int written = 0, seen = 0;
  team.Run([&](int worker) {
    if (worker == 1) {
      std::this_thread::sleep_for(std::chrono::milliseconds(20));  // far longer than any spinning
      written = 7;
    }
    barrier.Wait(worker);
    if (worker == 0) seen = written;
  });
  EXPECT_EQ(seen, 7);
}

TEST(Barrier, ShowsAfterAwaitingWhatOthersWroteBeforeTheyArrived) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    Barrier barrier(size);
    std::vector<int> written(static_cast<size_t>(size)), aside(written.size());
    std::atomic<int> wrong{0};
    team.Run([&](int worker) {
      for (int phase = 1; phase <= 40; ++phase) {
        written[static_cast<size_t>(worker)] = phase;
        barrier.Arrive(worker);
        ++aside[static_cast<size_t>(worker)];
        barrier.Await(worker);
        barrier.Await(worker);  // does no harm
        for (int other : written) wrong += other != phase ? 1 : 0;
        barrier.Wait(worker);
      }
    });
    EXPECT_EQ(wrong, 0) << size << " workers";
    EXPECT_EQ(aside, std::vector<int>(aside.size(), 40));
  }
}

#if defined(__linux__)
// How long worker 0 of two was blocked, as the barrier says, by a worker that does `theirs` first,
// and how long that worker's processor ran other work meanwhile.
struct Blocked {
  Barrier::Duration time = {}, other_work = {};
};

template <typename Theirs>
Blocked BlockedBy(Theirs theirs) {
  WorkerTeam team(2);
  Barrier barrier(2);
  Blocked blocked;
  team.Run([&](int worker) {
    barrier.Guard(worker, [&] {
      barrier.Wait(worker);
      const auto start = std::chrono::steady_clock::now();
      if (worker == 1) blocked.other_work -= theirs();
      barrier.Arrive(worker);
      if (worker == 0) blocked.time = barrier.Await(worker);
      if (worker == 1) blocked.other_work += std::chrono::steady_clock::now() - start;
    });
  });
  return blocked;
}

std::chrono::nanoseconds TimeOfThread() {
  timespec time = {};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}

TEST(Barrier, IsBlockedByAWorkerThatDoesNotRunAndNotByOneThatHasMoreToDo) {
  constexpr std::chrono::milliseconds kTime(50);
  const Blocked by_work = BlockedBy([&] {
    const auto end = TimeOfThread() + kTime;
    while (TimeOfThread() < end) {
    }
    return kTime;
  });
  EXPECT_LT(by_work.time, by_work.other_work + kTime / 2);
  const Blocked by_sleep = BlockedBy([&] {
    std::this_thread::sleep_for(kTime);
    return kTime;
  });
  EXPECT_GT(by_sleep.time, kTime / 2);
}
#endif

TEST(WorkerTeam, ThrowsWhatOneOfItsWorkersThrowsAndGoesOn) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    for (int thrower = 0; thrower < std::min(size, 4); ++thrower) {
      std::atomic<int> others{0};
      const auto work = [&](int worker) {
        if (worker == thrower) throw std::bad_alloc();
        ++others;
      };
      EXPECT_THROW(team.Run(work), std::bad_alloc) << "worker " << thrower << " of " << size;
      EXPECT_EQ(others, size - 1);
    }
    team.Run([](int) {});
  }
}

TEST(Barrier, GuardedPartsEndTogetherWhenOneThrows) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    for (int thrower = 0; thrower < std::min(size, 4); ++thrower) {
      Barrier barrier(size);
      std::atomic<int> ended{0};
      const auto part = [&](int worker) {
        for (int phase = 0; phase < 10; ++phase) {
          if (phase == 5 && worker == thrower) throw std::bad_alloc();
          barrier.Wait(worker);
        }
        ++ended;
      };
      const auto work = [&](int worker) { barrier.Guard(worker, [&] { part(worker); }); };
      EXPECT_THROW(team.Run(work), std::bad_alloc) << "worker " << thrower << " of " << size;
      EXPECT_EQ(ended, 0);
    }
  }
}

TEST(Barrier, PartsThatArriveEarlyEndTogetherWhenOneThrows) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    Barrier barrier(size);
    std::atomic<int> ended{0};
    const auto part = [&](int worker) {
      for (int phase = 0; phase < 10; ++phase) {
        barrier.Await(worker);
        if (phase == 5 && worker == 0) throw std::bad_alloc();
        barrier.Arrive(worker);
      }
      barrier.Await(worker);
      ++ended;
    };
    const auto work = [&](int worker) { barrier.Guard(worker, [&] { part(worker); }); };
    EXPECT_THROW(team.Run(work), std::bad_alloc) << size << " workers";
    EXPECT_EQ(ended, 0);
  }
}

TEST(WorkerTeam, DoesWhatIsOfferedWithWhoeverComesAndTakesPartInTheNextRunWithAll) {
  for (int size : TeamSizes()) {
    WorkerTeam team(size);
    std::atomic<int> running{0}, late{0};
    std::vector<int> runs(static_cast<size_t>(size));
    for (int n = 1; n <= 200; ++n) {
      bool first = false;
      running = 0;
      team.Offer([&](int worker) {
        ++running;
        if (worker == 0) first = true;
        --running;
      });
      late += running;  // who has begun is waited for
      ASSERT_TRUE(first);
      if (n % 3 == 0) team.Run([&](int worker) { ++runs[static_cast<size_t>(worker)]; });
    }
    EXPECT_EQ(late, 0) << size << " workers";
    EXPECT_EQ(runs, std::vector<int>(runs.size(), 66));
    EXPECT_THROW(team.Offer([](int) { throw std::bad_alloc(); }), std::bad_alloc);
  }
}

// Worker 1 takes part for `theirs` while worker 0 only waits for it to begin. Returns: whether the
// team has confidence afterwards.
template <typename Theirs>
bool HasConfidenceAfter(WorkerTeam& team, Theirs theirs) {
  std::atomic<bool> begun{false};
  team.Offer([&](int worker) {
    if (worker == 0) {
      while (!begun) std::this_thread::yield();
    } else {
      begun = true;
      theirs();
    }
  });
  return team.in_offers().Holds();
}

#if defined(__linux__)
TEST(WorkerTeam, LosesConfidenceWhenOneWhoCameIsKeptFromWorking) {
  using std::chrono::milliseconds;
  cpu_set_t allowed, first;
  ASSERT_EQ(sched_getaffinity(0, sizeof(allowed), &allowed), 0);
  CPU_ZERO(&first);
  for (int cpu = 0; CPU_COUNT(&first) == 0; ++cpu) {
    if (CPU_ISSET(cpu, &allowed)) CPU_SET(cpu, &first);
  }
  // All threads that begin now share one processor, and one of them never sleeps.
  ASSERT_EQ(sched_setaffinity(0, sizeof(first), &first), 0);
  std::jthread busy([](const std::stop_token& stop) {
    while (!stop.stop_requested()) {
    }
  });
  WorkerTeam team(2);
  EXPECT_TRUE(team.in_offers().Holds());
  EXPECT_FALSE(HasConfidenceAfter(team, [] {
    const auto end = std::chrono::steady_clock::now() + milliseconds(200);
    while (std::chrono::steady_clock::now() < end) {
    }
  }));
  std::atomic<int> others{0};
  team.Offer([&](int worker) {
    if (worker != 0) ++others;
    std::this_thread::sleep_for(milliseconds(20));  // time to come, were it offered
  });
  EXPECT_EQ(others, 0);
  ASSERT_EQ(sched_setaffinity(0, sizeof(allowed), &allowed), 0);
}
#endif

// Who sleeps leaves its processor to others, but not because it has to. Tried again, since on a
// busy machine it may have to just when it wakes.
TEST(WorkerTeam, KeepsConfidenceWhenOneWhoCameHasMoreToDo) {
  const auto keeps = [](int) {
    WorkerTeam team(2);
    return HasConfidenceAfter(team,
                              [] { std::this_thread::sleep_for(std::chrono::milliseconds(20)); });
  };
  EXPECT_TRUE(std::ranges::any_of(std::vector{1, 2, 3, 4, 5}, keeps));
}

TEST(Portions, HandOutEveryItemOnce) {
  for (size_t count : {size_t{0}, size_t{1}, size_t{64}, size_t{1000}}) {
    for (size_t at_once : {size_t{1}, size_t{7}, size_t{64}, size_t{5000}}) {
      WorkerTeam team(3);
      Portions portions(count, at_once);
      std::vector<std::atomic<int>> taken(count);
      team.Run([&](int) {
        for (Share mine = portions.Take(); mine.begin < mine.end; mine = portions.Take()) {
          for (size_t n = mine.begin; n < mine.end; ++n) ++taken[n];
        }
      });
      for (size_t n = 0; n < count; ++n) EXPECT_EQ(taken[n], 1) << n << " of " << count;
    }
  }
}

TEST(ShareOf, CoversAllItemsOnceInOrderAndEvenly) {
  for (size_t count : {size_t{0}, size_t{1}, size_t{2}, size_t{7}, size_t{64}, size_t{1000003}}) {
    for (int workers : {1, 2, 3, 7, 64}) {
      size_t next = 0;
      for (int worker = 0; worker < workers; ++worker) {
        const Share share = ShareOf(count, worker, workers);
        EXPECT_EQ(share.begin, next);
        const size_t items = share.end - share.begin;
        EXPECT_GE(items, count / static_cast<size_t>(workers));
        EXPECT_LE(items, count / static_cast<size_t>(workers) + 1);
        next = share.end;
      }
      EXPECT_EQ(next, count) << workers << " workers";
    }
  }
}

TEST(ShareOf, HoldsForMoreItemsThanAnyVolumeHasBricks) {
  constexpr size_t kCount = size_t{1} << 40;
  static_assert(ShareOf(kCount, 255, 256).end == kCount);
  static_assert(ShareOf(kCount, 128, 256).begin == kCount / 2);
}

}  // namespace
}  // namespace bccskel::exec
