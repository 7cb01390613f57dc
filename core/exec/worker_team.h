#ifndef BCCSKEL_CORE_EXEC_WORKER_TEAM_H_
#define BCCSKEL_CORE_EXEC_WORKER_TEAM_H_

#include <algorithm>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace bccskel::exec {

// Whether it pays to let the workers of a team meet. Once the others have kept worker 0 waiting,
// since the machine had other work for their processors, it goes on alone for twelve times as long,
// and for twice as long as before when trying again does no good: on a machine that stays busy
// hardly any time is lost.
class Confidence {
 public:
  using Duration = std::chrono::steady_clock::duration;

  bool Holds() const { return Clock::now() >= alone_until_; }
  void Lose(Duration waited);
  // Workers met during this time, and it was no loss. What was before is forgotten once they have
  // been together for as long as the last pause.
  void Gain(Duration together);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point alone_until_ = {};
  Duration pause_ = {};     // the last one, while it is remembered
  Duration together_ = {};  // since then
};

// A fixed team of threads that run one function together. The caller is worker 0, so a team of one
// owns no thread and serial is simply a size of one. Between runs threads look out for the next one
// for some microseconds, since the stages of a job follow each other; then they block.
// Threads: Run() is not reentrant; one job owns one team at a time.
class WorkerTeam {
 public:
  explicit WorkerTeam(int size = 1);  // Needs: size >= 1.
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  int size() const { return size_; }

  // Worker 0's, from stage to stage.
  Confidence& confidence() { return confidence_; }

  // Calls `work(worker)` for worker = 0..size()-1 at the same time and returns when all are done.
  // What one of them throws, such as std::bad_alloc, is thrown again here once all are done; work
  // that meets at a Barrier must see to it that the others come to an end (Barrier::Guard()).
  void Run(const std::function<void(int worker)>& work);

  // The same for work that any worker can do alone, shared by the workers that join before worker 0
  // has finished: no worker that has not started is waited for, because waking is slow or the
  // processors are busy. Without confidence worker 0 works alone; waiting for a worker that was
  // preempted removes confidence.
  void Offer(const std::function<void(int worker)>& work);

 private:
  void Begin(const std::function<void(int)>& work, int others);
  void AwaitOthers();
  void JudgeOffer(Confidence::Duration together, Confidence::Duration waited);
  void Serve(std::stop_token stop, int worker);
  void Try(const std::function<void(int)>& work, int worker);

  const int size_;
  Confidence confidence_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable done_;
  const std::function<void(int)>* work_ = nullptr;  // guarded by mutex_; null once withdrawn
  bool offered_ = false;                 // guarded by mutex_; joining workers increment running_
  bool shared_ = false;                  // guarded by mutex_; a worker joined
  bool preempted_ = false;               // guarded by mutex_; and was kept from working
  std::atomic<uint64_t> generation_{0};  // changed under mutex_
  std::atomic<int> running_{0};          // changed under mutex_
  std::exception_ptr thrown_;            // guarded by mutex_; the first of a run
  std::vector<std::jthread> threads_;    // last: joined before the rest is destroyed
};

// A reusable meeting point of `size` workers. Spins for some microseconds, then blocks, so that a
// machine with fewer free processors than workers stays responsive.
// Each worker counts its meetings where only it writes and looks at the others' counts: the last to
// come is seen after one transfer between processors, where a common counter takes three, of 100 to
// 300 ns each; a pass over half of 850,000 points takes 2,000 ns and has two meetings.
class Barrier {
 public:
  using Duration = std::chrono::steady_clock::duration;

  explicit Barrier(int size) : meetings_(static_cast<size_t>(size)) {}
  // Both are called by each worker, 0..size-1, with its number. What a worker wrote before it
  // arrived others can read after they awaited it; between the two it can do what nobody needs.
  // Both throw what broke the barrier: a worker that will never come.
  void Arrive(int worker);
  // Until all have arrived as often as the caller. Any number of times.
  // Returns: for how long the caller was blocked; zero when the others came while it was spinning.
  Duration Await(int worker);

  Duration Wait(int worker) {
    Arrive(worker);
    return Await(worker);
  }

  // Runs a worker's part. Whatever it throws ends the others' parts at their next meeting, too, so
  // that nobody waits for ever; the barrier is of no further use.
  template <typename Part>
  void Guard(Part part) {
    try {
      part();
    } catch (...) {
      Break(std::current_exception());
      throw;
    }
  }

 private:
  struct alignas(128) Meetings {
    std::atomic<uint32_t> count{0};
  };

  Duration WaitFor(const Meetings& other, uint32_t count) const;
  void Break(std::exception_ptr cause);
  void CheckWhole() const {
    if (broken_.load(std::memory_order_acquire)) std::rethrow_exception(cause_);
  }

  std::vector<Meetings> meetings_;
  std::atomic<bool> breaking_{false};
  std::atomic<bool> broken_{false};
  std::exception_ptr cause_;  // written before broken_ is set, once
};

// Tells when a team is slower than one worker: where the machine does not let its members run at
// the same time, each meeting may cost a time slice of milliseconds for microseconds of work. Kept
// by worker 0, which then goes on alone.
class Patience {
 public:
  explicit Patience(double share) : share_(share) {}

  void Blocked(Barrier::Duration time) { blocked_ += time; }
  // More than its share of the time, and not just a hiccup, went into waiting, now or before.
  bool Lost() {
    constexpr auto kHiccup = std::chrono::microseconds(300);
    lost_ = lost_ || blocked_ - kHiccup > share_ * Elapsed();
    return lost_;
  }
  // At the end.
  void Tell(Confidence& confidence) {
    if (Lost()) {
      confidence.Lose(blocked_);
    } else {
      confidence.Gain(Elapsed());
    }
  }

 private:
  using Clock = std::chrono::steady_clock;
  Barrier::Duration Elapsed() const { return Clock::now() - start_; }

  double share_;
  Clock::time_point start_ = Clock::now();
  Barrier::Duration blocked_ = {};
  bool lost_ = false;
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

// Items that are handed out in order, some at a time, to whoever has nothing to do: where some take
// longer than others and it does not matter who takes which.
// Threads: safe.
class Portions {
 public:
  Portions(size_t count, size_t at_once) : count_(count), at_once_(at_once) {}

  // The next ones; an empty share when there are no more.
  Share Take() {
    const size_t begin = std::min(next_.fetch_add(at_once_, std::memory_order_relaxed), count_);
    return {begin, std::min(begin + at_once_, count_)};
  }

 private:
  const size_t count_;
  const size_t at_once_;
  std::atomic<size_t> next_{0};
};

}  // namespace bccskel::exec

#endif  // BCCSKEL_CORE_EXEC_WORKER_TEAM_H_
