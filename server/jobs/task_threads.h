#ifndef BCCSKEL_SERVER_JOBS_TASK_THREADS_H_
#define BCCSKEL_SERVER_JOBS_TASK_THREADS_H_

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <stop_token>
#include <thread>
#include <vector>

namespace bccskel::server {

// A few threads that run short tasks in the order in which they were posted.
class TaskThreads {
 public:
  explicit TaskThreads(int threads);  // Needs: threads >= 1.
  ~TaskThreads();                     // runs what was posted, then joins
  TaskThreads(const TaskThreads&) = delete;
  TaskThreads& operator=(const TaskThreads&) = delete;

  // `task` must not throw.
  void Post(std::function<void()> task);

 private:
  void Serve(std::stop_token stop);

  std::mutex mutex_;
  std::condition_variable_any wake_;
  std::deque<std::function<void()>> tasks_;  // guarded by mutex_
  std::vector<std::jthread> threads_;        // last: joined before the rest is destroyed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_JOBS_TASK_THREADS_H_
