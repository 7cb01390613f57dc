#include "server/jobs/task_threads.h"

#include <utility>

namespace bccskel::server {

TaskThreads::TaskThreads(int threads) {
  for (int n = 0; n < threads; ++n) {
    threads_.emplace_back([this](std::stop_token stop) { Serve(stop); });
  }
}

TaskThreads::~TaskThreads() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void TaskThreads::Post(std::function<void()> task) {
  {
    std::lock_guard lock(mutex_);
    tasks_.push_back(std::move(task));
  }
  wake_.notify_one();
}

void TaskThreads::Serve(std::stop_token stop) {
  while (true) {
    std::function<void()> task;
    {
      std::unique_lock lock(mutex_);
      wake_.wait(lock, stop, [this] { return !tasks_.empty(); });
      if (tasks_.empty()) return;
      task = std::move(tasks_.front());
      tasks_.pop_front();
    }
    task();
  }
}

}  // namespace bccskel::server
