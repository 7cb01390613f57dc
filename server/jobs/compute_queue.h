#ifndef BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_
#define BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <stop_token>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "core/exec/worker_team.h"
#include "server/jobs/fair_queue.h"

namespace bccskel::server {

// Assigns a fixed number of threads to jobs, in the order of a FairQueue. A job alone gets as many
// as it can use. Several that arrived lately, large or small, share the free threads: one thread
// each is faster overall than all threads for one after the other. A job that arrives while another
// has all threads starts on one thread, which the other leaves to it (share()). Results do not
// depend on the number of threads.
//
// A running job yields to small waiting ones: those that take one thread and have at most half of
// its bricks. They run on its thread while it pauses; it yields to their tenant again only after it
// has run for as long as they took. So beside one other tenant it runs at half speed or more, and
// no tenant waits because of what others took.
//
// The queue's threads, and those that jobs start on them, have a lower priority than the other
// threads of the process.
class ComputeQueue {
 public:
  using Clock = std::chrono::steady_clock;
  class Turn;
  using Work = std::function<void(Turn& turn)>;
  struct Waiting {
    std::string tenant;
    int most_threads;
    uint64_t bricks;
    Work work;
  };
  using Entry = FairQueue<Waiting>::Entry;
  struct Usage {
    int waiting = 0;
    int running = 0;  // counts a job that yielded, not the one it yielded to
    int busy_threads = 0;

    friend bool operator==(const Usage&, const Usage&) = default;
  };
  // What a job asks for.
  struct Claim {
    JobOrigin origin;
    int most_threads = 1;
    uint64_t bricks = 0;  // the job's size
  };

  // At most `max_running` jobs run at the same time. Needs: both >= 1. Tests pass their own clock.
  ComputeQueue(int threads, int max_running, TenantTable tenants = {},
               std::function<Clock::time_point()> now = &Clock::now);
  ~ComputeQueue();  // waits for running work and drops waiting work
  ComputeQueue(const ComputeQueue&) = delete;
  ComputeQueue& operator=(const ComputeQueue&) = delete;

  // Runs `work` on a thread of the queue, which counts among the threads of its turn. It must not
  // throw.
  Entry Post(const Claim& claim, Work work);
  bool Remove(const Entry& entry);  // false when it is not waiting

  void SetTenants(const TenantTable& tenants);  // applies to later turns

  int threads() const { return threads_; }
  Usage usage() const;

 private:
  using Taken = FairQueue<Waiting>::Taken;

  static constexpr uint64_t kNoBricks = UINT64_MAX;
  // Callers in a loop take less than this between two calls.
  static constexpr std::chrono::milliseconds kLately{100};

  void Serve(std::stop_token stop);
  void Run(Taken taken, int threads);
  std::unique_ptr<exec::WorkerTeam> TakeTeam(int size);
  void KeepTeam(std::unique_ptr<exec::WorkerTeam> team);
  std::optional<Taken> TakeSmaller(const Turn& turn);
  // Needs of these: mutex_ held.
  void FindLeastWaiting();
  void UpdateRecentLoad();
  int ThreadsFor(const Waiting& job) const;

  const int threads_;
  const std::function<Clock::time_point()> now_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  FairQueue<Waiting> queue_;  // guarded by mutex_
  // Lower bound of the bricks of queued jobs that take one thread. Changed with mutex_ held.
  std::atomic<uint64_t> least_waiting_ = kNoBricks;
  int running_ = 0;  // guarded by mutex_, as are the members below
  // Threads of running jobs; may exceed threads_. Changed with mutex_ held.
  std::atomic<int> given_threads_ = 0;
  int recent_load_ = 0;  // most jobs that recently waited or ran at the same time
  Clock::time_point recent_load_until_;
  // The team of the last job with several threads. The next job of that size need not start
  // threads, and knows whether lockstep has paid off on this machine lately.
  std::unique_ptr<exec::WorkerTeam> idle_team_;
  std::vector<std::jthread> runners_;  // last: joined before the rest is destroyed
};

// A running job's hold on its threads.
class ComputeQueue::Turn {
 public:
  int threads() const { return team_->size(); }
  exec::WorkerTeam& team() { return *team_; }
  // The number of threads to use now: threads() less those that have since been assigned to other
  // jobs; at least 1. Threads: safe.
  int share() const {
    const int others = queue_.given_threads_ - threads();
    return std::clamp(queue_.threads_ - others, 1, threads());
  }

  // Call from time to time, on any thread. On the thread that the job runs on, it may run small
  // waiting jobs. Costs next to nothing if no waiting job is small enough.
  void Yield();

 private:
  friend class ComputeQueue;
  Turn(ComputeQueue& queue, int threads, uint64_t bricks)
      : queue_(queue), team_(queue.TakeTeam(threads)), bricks_(bricks) {}
  ~Turn() { queue_.KeepTeam(std::move(team_)); }
  // The time on a clock that stops while the job pauses.
  Clock::time_point WorkedUntil() const { return queue_.now_() - rested_; }

  ComputeQueue& queue_;
  std::unique_ptr<exec::WorkerTeam> team_;
  const uint64_t bricks_;
  const std::thread::id thread_ = std::this_thread::get_id();
  Clock::duration rested_{};
  // When it may yield to a tenant again, on the clock of WorkedUntil().
  std::map<std::string, Clock::time_point> not_before_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_
