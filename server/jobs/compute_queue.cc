#include "server/jobs/compute_queue.h"

#include <algorithm>
#include <utility>

namespace bccskel::server {

ComputeQueue::ComputeQueue(int threads, int max_running)
    : threads_(threads), free_threads_(threads) {
  for (int n = 0; n < std::min(threads, max_running); ++n) {
    runners_.emplace_back([this](std::stop_token stop) { Serve(stop); });
  }
}

ComputeQueue::~ComputeQueue() {
  for (std::jthread& runner : runners_) runner.request_stop();
}

ComputeQueue::Entry ComputeQueue::Post(int most_threads, Work work) {
  Entry entry = 0;
  {
    std::lock_guard lock(mutex_);
    entry = next_entry_++;
    waiting_.push_back({entry, most_threads, std::move(work)});
  }
  wake_.notify_one();
  return entry;
}

ComputeQueue::Removal ComputeQueue::Remove(Entry entry) {
  std::lock_guard lock(mutex_);
  const size_t removed = waiting_.remove_if([entry](const Waiting& w) { return w.entry == entry; });
  return removed > 0 ? Removal::kRemoved : Removal::kNotWaiting;
}

ComputeQueue::Usage ComputeQueue::usage() const {
  std::lock_guard lock(mutex_);
  return {.waiting = static_cast<int>(waiting_.size()),
          .running = running_,
          .busy_threads = threads_ - free_threads_};
}

void ComputeQueue::Serve(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (wake_.wait(lock, stop, [this] { return !waiting_.empty() && free_threads_ > 0; })) {
    if (stop.stop_requested()) return;
    Waiting next = std::move(waiting_.front());
    waiting_.pop_front();
    const int threads = std::min(next.most_threads, free_threads_);
    free_threads_ -= threads;
    ++running_;
    lock.unlock();
    next.work(threads);
    next.work = nullptr;
    lock.lock();
    --running_;
    free_threads_ += threads;
    if (!waiting_.empty()) wake_.notify_all();
  }
}

}  // namespace bccskel::server
