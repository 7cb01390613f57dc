#ifndef BCCSKEL_SERVER_JOBS_TASK_THREADS_H_
#define BCCSKEL_SERVER_JOBS_TASK_THREADS_H_

#include <condition_variable>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

#include "server/jobs/fair_queue.h"

namespace bccskel::server {

// A few threads that run short tasks in the order of a FairQueue. If there are several threads, no
// tenant occupies all of them.
class TaskThreads {
 public:
  explicit TaskThreads(int threads, const TenantTable& tenants = {});  // Needs: threads >= 1.
  ~TaskThreads();  // runs all posted tasks, then joins
  TaskThreads(const TaskThreads&) = delete;
  TaskThreads& operator=(const TaskThreads&) = delete;

  void SetTenants(const TenantTable& tenants);  // applies to later tasks

  // `task` must not throw.
  void Post(const JobOrigin& origin, std::function<void()> task);

 private:
  void Serve(std::stop_token stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  FairQueue<std::function<void()>> tasks_;  // guarded by mutex_
  std::vector<std::jthread> threads_;       // last: joined before the rest is destroyed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_TASK_THREADS_H_
