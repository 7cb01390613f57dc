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

// Estimates whether working together pays. When worker 0 has been blocked because the machine ran
// other work on the processors of the others, it works alone for twelve times as long as it was
// blocked, and for twice the last pause if the next try fails, too. On a busy machine hardly any
// time is lost.
class Confidence {
 public:
  using Duration = std::chrono::steady_clock::duration;

  bool Holds() const { return Clock::now() >= alone_until_; }
  void Lose(Duration waited);
  // Workers worked together for this time without loss. Resets the pause after as much such time as
  // the last pause took.
  void Gain(Duration together);

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point alone_until_ = {};
  Duration pause_ = {};     // the last one, while it is remembered
  Duration together_ = {};  // time worked together since then
};

// A fixed team of threads that run one function together. The caller is worker 0, so a team of one
// owns no thread and serial is a size of one. Between runs threads spin for some microseconds,
// since the stages of a job follow each other; then they block. Threads: Run() is not reentrant;
// one job owns one team at a time.
class WorkerTeam {
 public:
  explicit WorkerTeam(int size = 1);  // Needs: size >= 1.
  ~WorkerTeam();
  WorkerTeam(const WorkerTeam&) = delete;
  WorkerTeam& operator=(const WorkerTeam&) = delete;

  int size() const { return size_; }

  // Whether lockstep and offered work pay: a machine too busy for lockstep often has time for
  // offered work. Used by worker 0 only; kept across stages.
  Confidence& in_lockstep() { return in_lockstep_; }
  Confidence& in_offers() { return in_offers_; }

  // Calls `work(worker)` for worker = 0..size()-1 concurrently and returns when all are done.
  // Rethrows what one of them throws, such as std::bad_alloc, once all are done; work that waits at
  // a Barrier must make sure that the others end (Barrier::Guard()).
  void Run(const std::function<void(int worker)>& work);

  // The same for work that any worker can do alone. Workers that join before worker 0 has finished
  // share it; Offer() does not wait for workers that have not started because waking is slow or the
  // processors are busy. Without confidence in offers worker 0 works alone; waiting for a worker
  // that was preempted reduces confidence.
  void Offer(const std::function<void(int worker)>& work);

 private:
  void Begin(const std::function<void(int)>& work, int others);
  void AwaitOthers();
  void JudgeOffer(Confidence::Duration together, Confidence::Duration waited);
  void Serve(std::stop_token stop, int worker);
  void Try(const std::function<void(int)>& work, int worker);

  const int size_;
  Confidence in_lockstep_;
  Confidence in_offers_;
  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::condition_variable done_;
  const std::function<void(int)>* work_ = nullptr;  // guarded by mutex_; null once withdrawn
  bool offered_ = false;                 // guarded by mutex_; joining workers increment running_
  bool shared_ = false;                  // guarded by mutex_; another worker joined
  bool preempted_ = false;               // guarded by mutex_; and was kept from running
  std::atomic<uint64_t> generation_{0};  // changed under mutex_
  std::atomic<int> running_{0};          // changed under mutex_
  std::exception_ptr thrown_;            // guarded by mutex_; the first of a run
  std::vector<std::jthread> threads_;    // last: joined before the rest is destroyed
};

// A reusable barrier of `size` workers. Spins for some microseconds, then blocks, so that a
// machine with fewer free processors than workers stays responsive.
// Each worker has its own count and reads those of the others: the last arrival is visible after
// one cache-line transfer of 100 to 300 ns, where a common counter takes three; a pass over half of
// 850,000 points takes 2,000 ns and has two barriers.
class Barrier {
 public:
  using Duration = std::chrono::steady_clock::duration;

  explicit Barrier(int size) : meetings_(static_cast<size_t>(size)) {}
  // Each worker, 0..size-1, calls both with its number. What a worker wrote before Arrive() is
  // visible to the others after Await(); in between it may do work that the others do not need.
  // Both throw what broke the barrier: a worker that will never arrive.
  void Arrive(int worker);
  // Until all have arrived as often as the caller. Any number of times.
  // Returns: how long the caller was blocked by workers that were kept from running; zero if the
  // others arrived while it was spinning. A worker that has more to do is not kept from running, as
  // far as the system tells how much processor time it took; if not, all of the time counts.
  Duration Await(int worker);

  Duration Wait(int worker) {
    Arrive(worker);
    return Await(worker);
  }

  // Runs a worker's part. What it throws also ends the others at their next barrier, so that none
  // waits forever; the barrier cannot be used afterwards.
  template <typename Part>
  void Guard(int worker, Part part) {
    meetings_[static_cast<size_t>(worker)].clock = ClockOfThisThread();
    try {
      part();
    } catch (...) {
      Break(std::current_exception());
      throw;
    }
  }

 private:
  static constexpr int kNoClock = 0;
  struct alignas(128) Meetings {
    std::atomic<uint32_t> count{0};
    // Of the processor time of the worker's thread, once it runs.
    std::atomic<int> clock{kNoClock};
  };

  static int ClockOfThisThread();
  static Duration ProcessorTime(int clock);
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

// Detects when a team is slower than one worker: if workers are not co-scheduled, each barrier may
// cost a time slice of milliseconds for microseconds of work. Used by worker 0, which then
// continues alone.
class Patience {
 public:
  explicit Patience(double share) : share_(share) {}

  void Blocked(Barrier::Duration time) { blocked_ += time; }
  // Whether waiting has taken more than its share of the time, ignoring a single outlier.
  bool Lost() {
    constexpr auto kHiccup = std::chrono::microseconds(300);
    lost_ = lost_ || blocked_ - kHiccup > share_ * Elapsed();
    return lost_;
  }
  // Called at the end.
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

// Hands out items in order, some at a time, to workers that are free: for items of unequal cost
// that any worker may take. Threads: safe.
class Portions {
 public:
  Portions(size_t count, size_t at_once) : count_(count), at_once_(at_once) {}

  // The next items; an empty share at the end.
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
