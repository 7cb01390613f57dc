#ifndef BCCSKEL_SERVER_DURABLE_FLOW_H_
#define BCCSKEL_SERVER_DURABLE_FLOW_H_

#include <chrono>
#include <condition_variable>
#include <coroutine>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

namespace bccskel::server {

// Counts operations in progress, so that their owner can wait for them.
// Threads: safe.
class Operations {
 public:
  using Token = std::shared_ptr<void>;

  // In progress until the last copy of the token is gone.
  Token Begin() {
    std::lock_guard lock(mutex_);
    ++count_;
    return Token(this, [](Operations* self) { self->End(); });
  }
  void WaitForAll() {
    std::unique_lock lock(mutex_);
    none_.wait(lock, [this] { return count_ == 0; });
  }
  // The same, but not longer than this.
  void WaitForAll(std::chrono::milliseconds timeout) {
    std::unique_lock lock(mutex_);
    none_.wait_for(lock, timeout, [this] { return count_ == 0; });
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

// The return type of a coroutine that reads as sequential code and suspends in between. It begins
// on its caller's thread and resumes on the thread that delivers what it waits for. Nobody waits
// for its end, but it counts among the operations of its object. Needs: parameters passed by value.
struct Flow {
  class promise_type {
   public:
    template <typename Object, typename... Arguments>
    explicit promise_type(Object& object, const Arguments&...)
        : operation_(object.BeginOperation()) {}
    Flow get_return_object() { return {}; }
    std::suspend_never initial_suspend() noexcept { return {}; }
    std::suspend_never final_suspend() noexcept { return {}; }
    void return_void() {}
    void unhandled_exception() { std::terminate(); }

   private:
    const Operations::Token operation_;
  };
};

// Made by Await().
template <typename Value, typename Start>
class Awaited {
 public:
  explicit Awaited(Start start) : start_(std::move(start)) {}
  bool await_ready() const { return false; }
  void await_suspend(std::coroutine_handle<> flow) {
    start_([this, flow](Value value = Value()) {
      value_.emplace(std::move(value));
      flow.resume();
    });
  }
  Value await_resume() { return *std::move(value_); }

 private:
  Start start_;
  std::optional<Value> value_;
};

// Suspends a flow until a value arrives. `start` is called with a callback that takes the value;
// the callback must be called once, on any thread, possibly before `start` returns.
template <typename Value, typename Start>
auto Await(Start start) {
  return Awaited<Value, Start>(std::move(start));
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FLOW_H_
