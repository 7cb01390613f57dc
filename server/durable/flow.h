#ifndef BCCSKEL_SERVER_DURABLE_FLOW_H_
#define BCCSKEL_SERVER_DURABLE_FLOW_H_

#include <condition_variable>
#include <coroutine>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

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

// What a coroutine returns that is written from front to end and waits in between. It begins on its
// caller's thread and goes on on the thread that brings what it waits for. Nobody waits for its
// end, but it is counted among the operations of its object. Needs: parameters that are values.
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

// A flow waits for the value with which `start` has a function called, which it is given: once, on
// any thread, also before it returns.
template <typename Value, typename Start>
auto Await(Start start) {
  return Awaited<Value, Start>(std::move(start));
}

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FLOW_H_
