#ifndef BCCSKEL_SERVER_DURABLE_OPERATIONS_H_
#define BCCSKEL_SERVER_DURABLE_OPERATIONS_H_

#include <condition_variable>
#include <memory>
#include <mutex>

namespace bccskel::server {

// Counts what is under way, so that its owner can wait for it.
// Threads: safe.
class Operations {
 public:
  using Token = std::shared_ptr<void>;

  // Under way until the last copy is gone.
  Token Begin() {
    std::lock_guard lock(mutex_);
    ++count_;
    return Token(this, [](Operations* self) { self->End(); });
  }
  void WaitForAll() {
    std::unique_lock lock(mutex_);
    none_.wait(lock, [this] { return count_ == 0; });
  }

 private:
  void End() {
    std::lock_guard lock(mutex_);
    if (--count_ == 0) none_.notify_all();
  }

  std::mutex mutex_;
  std::condition_variable none_;
  int count_ = 0;  // guarded by mutex_
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_OPERATIONS_H_
