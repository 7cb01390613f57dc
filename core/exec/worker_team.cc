#include "core/exec/worker_team.h"

#include <utility>

#if defined(__linux__)
#include <pthread.h>
#include <sys/resource.h>

#include <ctime>
#endif
#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace bccskel::exec {
namespace {

using Clock = std::chrono::steady_clock;

// Longer than a normal pass over a small object, far shorter than a time slice. A pause instruction
// takes 40 to 140 cycles, depending on the processor, so the clock decides.
constexpr auto kSpinTime = std::chrono::microseconds(100);
constexpr int kPausesPerLook = 16;

void Pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

// Returns whether the condition became true in time. Does not spin if there are more workers than
// processors, since the others could not run meanwhile. Calls `between` about every microsecond.
template <typename Condition, typename Between>
bool SpinUntil(size_t workers, Condition condition, Between between) {
  static const size_t processors = std::thread::hardware_concurrency();
  if (condition()) return true;
  if (workers > processors) return false;
  const Clock::time_point end = Clock::now() + kSpinTime;
  do {
    for (int pause = 0; pause < kPausesPerLook; ++pause) {
      if (condition()) return true;
      Pause();
    }
    between();
  } while (Clock::now() < end);
  return false;
}
template <typename Condition>
bool SpinUntil(size_t workers, Condition condition) {
  return SpinUntil(workers, condition, [] {});
}

constexpr Confidence::Duration kLongestPause = std::chrono::milliseconds(3200);

#if defined(__linux__)
Clock::duration TimeOf(clockid_t clock) {
  timespec time = {};
  if (clock_gettime(clock, &time) != 0) return {};
  return std::chrono::seconds(time.tv_sec) + std::chrono::nanoseconds(time.tv_nsec);
}
#endif

// Share of the time of offered work; shorter waits are no loss, since the others did their part.
constexpr double kMostWaiting = 0.2;

// Measures whether the calling thread is kept from running.
class RunningTime {
 public:
  // Whether it was preempted since construction, and did not run for a good part of the time.
  bool WasKeptFromRunning() const {
    const Clock::duration passed = Clock::now() - start_, ran = ProcessorTime() - had_run_;
    return TimesPreempted() != preempted_ && passed - ran > kMostWaiting * passed;
  }

 private:
  static long TimesPreempted() {
#if defined(__linux__)
    rusage usage = {};
    if (getrusage(RUSAGE_THREAD, &usage) == 0) return usage.ru_nivcsw;
#endif
    return 0;
  }
  static Clock::duration ProcessorTime() {
#if defined(__linux__)
    return TimeOf(CLOCK_THREAD_CPUTIME_ID);
#endif
    return {};
  }

  const Clock::time_point start_ = Clock::now();
  const Clock::duration had_run_ = ProcessorTime();
  const long preempted_ = TimesPreempted();
};

}  // namespace

void Confidence::Lose(Duration waited) {
  pause_ = std::min(std::max(2 * pause_, 12 * waited), kLongestPause);
  together_ = {};
  alone_until_ = Clock::now() + pause_;
}

void Confidence::Gain(Duration together) {
  together_ += together;
  if (together_ >= pause_) pause_ = {};
}

WorkerTeam::WorkerTeam(int size) : size_(size) {
  for (int worker = 1; worker < size_; ++worker) {
    threads_.emplace_back([this, worker](std::stop_token stop) { Serve(stop, worker); });
  }
}

WorkerTeam::~WorkerTeam() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void WorkerTeam::Run(const std::function<void(int)>& work) {
  if (size_ == 1) {
    work(0);
    return;
  }
  Begin(work, size_ - 1);
  Try(work, 0);
  AwaitOthers();
}

void WorkerTeam::Offer(const std::function<void(int)>& work) {
  if (size_ == 1 || !in_offers_.Holds()) {
    work(0);
    return;
  }
  const Clock::time_point start = Clock::now();
  Begin(work, 0);
  Try(work, 0);
  const Clock::time_point done = Clock::now();
  {
    std::lock_guard lock(mutex_);
    work_ = nullptr;
  }
  AwaitOthers();
  const Clock::time_point end = Clock::now();
  JudgeOffer(end - start, end - done);
}

// Portions may be uneven: waiting for a worker that was not preempted is no loss.
void WorkerTeam::JudgeOffer(Confidence::Duration together, Confidence::Duration waited) {
  std::lock_guard lock(mutex_);
  if (!shared_) return;
  if (preempted_ && waited > kSpinTime && waited > kMostWaiting * together) {
    in_offers_.Lose(waited);
  } else {
    in_offers_.Gain(together);
  }
}

void WorkerTeam::Begin(const std::function<void(int)>& work, int others) {
  {
    std::lock_guard lock(mutex_);
    work_ = &work;
    running_ = others;
    offered_ = others == 0;
    shared_ = preempted_ = false;
    ++generation_;
  }
  wake_.notify_all();
}

void WorkerTeam::AwaitOthers() {
  SpinUntil(static_cast<size_t>(size_), [this] { return running_ == 0; });
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return running_ == 0; });
  if (thrown_ != nullptr) std::rethrow_exception(std::exchange(thrown_, nullptr));
}

void WorkerTeam::Try(const std::function<void(int)>& work, int worker) {
  try {
    work(worker);
  } catch (...) {
    std::lock_guard lock(mutex_);
    if (thrown_ == nullptr) thrown_ = std::current_exception();
  }
}

void WorkerTeam::Serve(std::stop_token stop, int worker) {
  uint64_t seen = 0;
  while (true) {
    const std::function<void(int)>* work = nullptr;
    // On a busy machine worker 0 may share this processor, so yield to it. (At a barrier this would
    // count as waiting, so no thread yields there.)
    SpinUntil(
        static_cast<size_t>(size_), [&] { return generation_ != seen; }, std::this_thread::yield);
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return generation_ != seen; })) return;
      seen = generation_;
      work = work_;
      if (work == nullptr) continue;
      if (offered_) ++running_;
      shared_ = true;
    }
    const RunningTime time;
    Try(*work, worker);
    const bool kept_from_running = time.WasKeptFromRunning();
    std::lock_guard lock(mutex_);
    preempted_ = preempted_ || kept_from_running;
    if (--running_ == 0) done_.notify_one();
  }
}

void Barrier::Arrive(int worker) {
  std::atomic<uint32_t>& own = meetings_[static_cast<size_t>(worker)].count;
  own.fetch_add(1);
  own.notify_all();
  CheckWhole();
}

Barrier::Duration Barrier::Await(int worker) {
  // Break() raises all counts: a worker that sees its own count raised also sees that the barrier
  // is broken.
  const uint32_t count = meetings_[static_cast<size_t>(worker)].count.load();
  CheckWhole();
  Duration blocked = {};
  for (const Meetings& other : meetings_) blocked += WaitFor(other, count);
  CheckWhole();
  return blocked;
}

// The clock's number, or kNoClock, which is the number of a clock of no thread.
int Barrier::ClockOfThisThread() {
#if defined(__linux__)
  static_assert(CLOCK_REALTIME == kNoClock);
  clockid_t clock = kNoClock;
  if (pthread_getcpuclockid(pthread_self(), &clock) == 0) return clock;
#endif
  return kNoClock;
}

// Zero where the system does not tell.
Barrier::Duration Barrier::ProcessorTime(int clock) {
#if defined(__linux__)
  if (clock != kNoClock) return TimeOf(clock);
#endif
  return {};
}

// Counts may be one ahead: a worker that has seen all arrive goes on to the next meeting.
Barrier::Duration Barrier::WaitFor(const Meetings& other, uint32_t count) const {
  const auto has_come = [&] {
    const uint32_t theirs = other.count.load(std::memory_order_acquire);
    return static_cast<int32_t>(theirs - count) >= 0;
  };
  if (SpinUntil(meetings_.size(), has_come)) return {};
  const Clock::time_point start = Clock::now();
  const int clock = other.clock.load();
  const Duration had_run = ProcessorTime(clock);
  while (!has_come()) other.count.wait(count - 1, std::memory_order_acquire);
  const Duration blocked = Clock::now() - start, ran = ProcessorTime(clock) - had_run;
  return std::max(blocked - ran, Duration::zero());
}

// Counts that are far ahead release all waiting workers; later ones see that the barrier is broken.
void Barrier::Break(std::exception_ptr cause) {
  if (breaking_.exchange(true)) return;
  cause_ = std::move(cause);
  broken_.store(true, std::memory_order_release);
  constexpr uint32_t kFarAhead = uint32_t{1} << 30;
  for (Meetings& meetings : meetings_) {
    meetings.count.fetch_add(kFarAhead, std::memory_order_acq_rel);
    meetings.count.notify_all();
  }
}

}  // namespace bccskel::exec
