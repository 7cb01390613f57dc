#include "core/exec/worker_team.h"

#if defined(__x86_64__)
#include <immintrin.h>
#endif

namespace bccskel::exec {
namespace {

// About 20 us on current machines: longer than a healthy pass, far shorter than a time slice.
constexpr int kSpinsBeforeBlocking = 2000;

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
  work(0);
  std::unique_lock lock(mutex_);
  done_.wait(lock, [this] { return running_ == 0; });
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
    (*work)(worker);
    std::lock_guard lock(mutex_);
    if (--running_ == 0) done_.notify_one();
  }
}

Barrier::Barrier(int size)
    : size_(size),
      spins_(static_cast<unsigned>(size) <= std::thread::hardware_concurrency()
                 ? kSpinsBeforeBlocking
                 : 0) {}

void Barrier::Wait() {
  if (size_ == 1) return;
  const uint32_t phase = phase_.load(std::memory_order_acquire);
  if (arrived_.fetch_add(1, std::memory_order_acq_rel) + 1 == size_) {
    arrived_.store(0, std::memory_order_relaxed);
    phase_.fetch_add(1, std::memory_order_acq_rel);
    phase_.notify_all();
    return;
  }
  for (int spin = 0; spin < spins_; ++spin) {
    if (phase_.load(std::memory_order_acquire) != phase) return;
    Pause();
  }
  phase_.wait(phase, std::memory_order_acquire);
}

}  // namespace bccskel::exec
