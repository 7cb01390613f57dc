#ifndef BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_
#define BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <list>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace bccskel::server {

// Hands out a fixed number of threads to jobs, first come, first served. A job gets as many of
// those that are free as it can use, at least one: a large job alone has the whole machine, and
// small jobs run side by side. Results do not depend on the number of threads.
class ComputeQueue {
 public:
  using Work = std::function<void(int threads)>;
  using Entry = uint64_t;
  struct Usage {
    int waiting = 0;
    int running = 0;
    int busy_threads = 0;

    friend bool operator==(const Usage&, const Usage&) = default;
  };

  // `max_running` jobs at the same time. Needs: both >= 1.
  ComputeQueue(int threads, int max_running);
  ~ComputeQueue();  // waits for running work; what still waits is dropped
  ComputeQueue(const ComputeQueue&) = delete;
  ComputeQueue& operator=(const ComputeQueue&) = delete;

  // `work` runs on a thread of the queue, which is one of the `threads` that it may keep busy. It
  // must not throw.
  Entry Post(int most_threads, Work work);
  enum class Removal { kRemoved, kNotWaiting };
  Removal Remove(Entry entry);

  int threads() const { return threads_; }
  Usage usage() const;

 private:
  struct Waiting {
    Entry entry;
    int most_threads;
    Work work;
  };

  void Serve(std::stop_token stop);

  const int threads_;
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  std::list<Waiting> waiting_;         // guarded by mutex_
  Entry next_entry_ = 1;               // guarded by mutex_
  int running_ = 0;                    // guarded by mutex_
  int free_threads_;                   // guarded by mutex_
  std::vector<std::jthread> runners_;  // last: joined before the rest is destroyed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_COMPUTE_QUEUE_H_
