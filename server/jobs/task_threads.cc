#include "server/jobs/task_threads.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace bccskel::server {
namespace {

// Drops the caps on running jobs, which concern computing.
TenantTable WeightsOf(TenantTable tenants) {
  tenants.each.max_running = 0;
  for (auto& [name, limits] : tenants.named) limits.max_running = 0;
  return tenants;
}

}  // namespace

TaskThreads::TaskThreads(int threads, const TenantTable& tenants)
    : tasks_(WeightsOf(tenants), std::max(1, threads - 1)) {
  for (int n = 0; n < threads; ++n) {
    threads_.emplace_back([this](std::stop_token stop) { Serve(stop); });
  }
}

TaskThreads::~TaskThreads() {
  for (std::jthread& thread : threads_) thread.request_stop();
}

void TaskThreads::SetTenants(const TenantTable& tenants) {
  std::lock_guard lock(mutex_);
  tasks_.SetLimits(WeightsOf(tenants));
}

void TaskThreads::Post(const JobOrigin& origin, std::function<void()> task) {
  {
    std::lock_guard lock(mutex_);
    tasks_.Push(origin, std::chrono::steady_clock::now(), std::move(task));
  }
  wake_.notify_one();
}

void TaskThreads::Serve(std::stop_token stop) {
  std::unique_lock lock(mutex_);
  while (true) {
    wake_.wait(lock, stop, [this] { return tasks_.Has(); });
    auto next = tasks_.Take();
    if (!next.has_value()) return;
    lock.unlock();
    next->item();
    next->item = nullptr;
    lock.lock();
    tasks_.Done(next->tenant);
    if (!tasks_.empty()) wake_.notify_one();
  }
}

}  // namespace bccskel::server
