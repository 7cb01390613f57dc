#ifndef BCCSKEL_CORE_EXEC_WORKER_TEAM_H_
#define BCCSKEL_CORE_EXEC_WORKER_TEAM_H_

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace bccskel::exec {

// A fixed team of threads that run one function together. The caller is worker 0, so a team of one
// owns no thread and serial is simply a size of one.
// Threads: Run() is not reentrant; one job owns one team at a time.
class WorkerTeam {
 public:
  explicit WorkerTeam(int size = 1);  // Needs: size >= 1.
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  int size() const { return size_; }

  // Calls `work(worker)` for worker = 0..size()-1 at the same time and returns when all are done.
  // `work` must not throw.
  void Run(const std::function<void(int worker)>& work);

 private:
  void Serve(std::stop_token stop, int worker);

  const int size_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable done_;
  const std::function<void(int)>* work_ = nullptr;  // guarded by mutex_
  uint64_t generation_ = 0;                         // guarded by mutex_
  int running_ = 0;                                 // guarded by mutex_
  std::vector<std::jthread> threads_;               // last: joined before the rest is destroyed
};

// A reusable meeting point of `size` workers. Spins for a bounded time, then blocks, so that a
// machine with fewer free cores than workers stays responsive.
class Barrier {
 public:
  explicit Barrier(int size);
  void Wait();

 private:
  const int size_;
  const int spins_;  // none when there are more workers than processors
  std::atomic<int> arrived_{0};
  std::atomic<uint32_t> phase_{0};
};

// The half-open range of items that `worker` of `workers` owns when `count` items are split evenly.
struct Share {
  size_t begin;
  size_t end;
};
constexpr Share ShareOf(size_t count, int worker, int workers) {
  const auto w = static_cast<size_t>(worker), n = static_cast<size_t>(workers);
  return {count * w / n, count * (w + 1) / n};
}

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_WORKER_TEAM_H_
