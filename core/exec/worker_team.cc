#include "core/exec/worker_team.h"

#include <utility>

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace bccskel::exec {
namespace {

using Clock = std::chrono::steady_clock;

// Longer than a healthy pass over a small object, far shorter than a time slice. Pauses last 40 to
// 140 cycles, depending on the processor, so the clock decides.
constexpr auto kSpinTime = std::chrono::microseconds(20);
constexpr int kPausesPerLook = 16;

void Pause() {
#if defined(__x86_64__)
  _mm_pause();
#endif
}

}  // namespace

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
  {
    std::lock_guard lock(mutex_);
    work_ = &work;
    running_ = size_ - 1;
    ++generation_;
  }
  wake_.notify_all();
  Try(work, 0);
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
    {
      std::unique_lock lock(mutex_);
      if (!wake_.wait(lock, stop, [&] { return generation_ != seen; })) return;
      seen = generation_;
      work = work_;
    }
    Try(*work, worker);
    std::lock_guard lock(mutex_);
    if (--running_ == 0) done_.notify_one();
  }
}

// Returns false when the time was not enough.
bool Barrier::SpinUntilPast(uint32_t phase) const {
  // With more workers than processors the others cannot come while this one spins.
  static const auto processors = static_cast<int>(std::thread::hardware_concurrency());
  if (size_ > processors) return false;
  const Clock::time_point end = Clock::now() + kSpinTime;
  do {
    for (int pause = 0; pause < kPausesPerLook; ++pause) {
      if (phase_.load(std::memory_order_acquire) != phase) return true;
      Pause();
    }
  } while (Clock::now() < end);
  return false;
}

Barrier::Duration Barrier::Wait() {
  if (size_ == 1) return {};
  const uint32_t phase = phase_.load(std::memory_order_acquire);
  CheckWhole();
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == size_) {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.fetch_add(1, std::memory_order_acq_rel);
    phase_.notify_all();
    return {};
  }
  if (SpinUntilPast(phase)) {
    CheckWhole();
    return {};
  }
  const Clock::time_point start = Clock::now();
  phase_.wait(phase, std::memory_order_acquire);
  CheckWhole();
  return Clock::now() - start;
}

// A new phase lets go of everyone who waits; whoever comes later sees that the barrier is broken.
void Barrier::Break(std::exception_ptr cause) {
  if (breaking_.exchange(true)) return;
  cause_ = std::move(cause);
  broken_.store(true, std::memory_order_release);
  phase_.fetch_add(1, std::memory_order_acq_rel);
  phase_.notify_all();
}

}  // namespace bccskel::exec
