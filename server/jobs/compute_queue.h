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

// Hands out a fixed number of threads to jobs, in the order of a FairQueue. A job alone gets as
// many as it can use. Where several came lately, large or small, they share those that are free:
// one thread each does more for all than all threads for one after the other. A job that comes
// while one has all threads starts beside it on one thread, which the other leaves to it (share()).
// Results do not depend on the number of threads.
//
// A job at work gives way to small ones that wait: to those that take one thread and have at most
// half of its bricks. They run on its thread while it rests; afterwards it gives way to their
// tenant only when it has had as much time as they took. So beside one other tenant it goes on at
// half speed or more, and nobody waits for what it owes to others.
//
// Its threads, and those that jobs start on them, have a lower priority than others of the process.
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
    int running = 0;  // those that gave way, not those that they gave way to
    int busy_threads = 0;

    friend bool operator==(const Usage&, const Usage&) = default;
  };
  // What a job asks for.
  struct Claim {
    JobOrigin origin;
    int most_threads = 1;
    uint64_t bricks = 0;  // the job's size
  };

  // `max_running` jobs at the same time. Needs: both >= 1. Tests bring a clock of their own.
  ComputeQueue(int threads, int max_running, TenantTable tenants = {},
               std::function<Clock::time_point()> now = &Clock::now);
  ~ComputeQueue();  // waits for running work; what still waits is dropped
  ComputeQueue(const ComputeQueue&) = delete;
  ComputeQueue& operator=(const ComputeQueue&) = delete;

  // `work` runs on a thread of the queue, which is one of those that it may keep busy. It must not
  // throw.
  Entry Post(const Claim& claim, Work work);
  bool Remove(const Entry& entry);  // false when it does not wait (any more)

  void SetTenants(const TenantTable& tenants);  // from now on

  int threads() const { return threads_; }
  Usage usage() const;

 private:
  using Taken = FairQueue<Waiting>::Taken;

  static constexpr uint64_t kNoBricks = UINT64_MAX;
  // Callers that call again and again are between two calls for less.
  static constexpr std::chrono::milliseconds kLately{100};

  void Serve(std::stop_token stop);
  void Run(Taken taken, int threads);
  std::unique_ptr<exec::WorkerTeam> TakeTeam(int size);
  void KeepTeam(std::unique_ptr<exec::WorkerTeam> team);
  std::optional<Taken> TakeSmaller(const Turn& turn);
  // Needs of these: mutex_ held.
  void FindLeastWaiting();
  void CountCrowd();
  int ThreadsFor(const Waiting& job) const;

  const int threads_;
  const std::function<Clock::time_point()> now_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  FairQueue<Waiting> queue_;  // guarded by mutex_
  // No job in queue_ that takes one thread has fewer bricks. Changed with mutex_ held.
  std::atomic<uint64_t> least_waiting_ = kNoBricks;
  int running_ = 0;  // guarded by mutex_, as are those below
  // To running jobs; may be more than there are. Changed with mutex_ held.
  std::atomic<int> given_threads_ = 0;
  int crowd_ = 0;  // most jobs that waited or ran together lately
  Clock::time_point crowd_until_;
  // Of the last job that had several threads. The next one of that size need not start threads, and
  // knows whether lockstep has paid on this machine lately.
  std::unique_ptr<exec::WorkerTeam> idle_team_;
  std::vector<std::jthread> runners_;  // last: joined before the rest is destroyed
};

// A job's time at work.
class ComputeQueue::Turn {
 public:
  int threads() const { return team_->size(); }
  exec::WorkerTeam& team() { return *team_; }
  // Those of them that others have not been given since; at least 1. Threads: safe.
  int share() const {
    const int others = queue_.given_threads_ - threads();
    return std::clamp(queue_.threads_ - others, 1, threads());
  }

  // To be called now and then, on any thread: on the one that the job runs on, small jobs that wait
  // may be run in between. Costs next to nothing where none wait that are small enough.
  void Yield();

 private:
  friend class ComputeQueue;
  Turn(ComputeQueue& queue, int threads, uint64_t bricks)
      : queue_(queue), team_(queue.TakeTeam(threads)), bricks_(bricks) {}
  ~Turn() { queue_.KeepTeam(std::move(team_)); }
  // What its clock would show had it stood still at rest.
  Clock::time_point WorkedUntil() const { return queue_.now_() - rested_; }

  ComputeQueue& queue_;
  std::unique_ptr<exec::WorkerTeam> team_;
  const uint64_t bricks_;
  const std::thread::id thread_ = std::this_thread::get_id();
  Clock::duration rested_{};
  std::map<std::string, Clock::time_point> not_before_;  // on that clock, again to this tenant
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_
