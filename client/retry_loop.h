#ifndef BCCSKEL_CLIENT_RETRY_LOOP_H_
#define BCCSKEL_CLIENT_RETRY_LOOP_H_

#include <chrono>
#include <optional>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "client/retry_policy.h"

namespace bccskel::client {

// The attempts at one call. They share one deadline; a pause that would exceed it is not begun.
// Threads: one at a time.
class RetryLoop {
 public:
  // What ends an attempt.
  struct Limits {
    std::stop_token stop;
    std::chrono::system_clock::time_point deadline;
  };
  using Clock = std::chrono::system_clock;

  // Needs: `pause` outlives the loop.
  RetryLoop(const RetryPolicy& policy, const Pause& pause, std::chrono::milliseconds timeout,
            std::stop_token stop)
      : policy_(policy),
        pause_(pause),
        stop_(std::move(stop)),
        deadline_(Clock::now() + timeout),
        pauses_(policy) {}

  // Calls `attempt(limits)` until it succeeds or is not to be repeated; returns its last status.
  template <typename Attempt>
  auto Run(Attempt attempt) -> decltype(attempt(Limits())) {
    while (true) {
      auto result = attempt(Limits{stop_, deadline_});
      if (result.ok()) return result;
      if (auto end = EndAfter(StatusOf(result)); end.has_value()) return *std::move(end);
    }
  }

  // The current attempt is the last.
  void Stop() { is_last_ = true; }

  // The attempt made progress: resets the pauses and the count of attempts.
  void Progressed() { pauses_ = RetryPauses(policy_); }

 private:
  static absl::Status StatusOf(const absl::Status& status) { return status; }
  template <typename Value>
  static absl::Status StatusOf(const absl::StatusOr<Value>& value) {
    return value.status();
  }

  // Pauses and yields nullopt if the call should be tried again after this error; else yields the
  // call's final status.
  std::optional<absl::Status> EndAfter(const absl::Status& error) {
    const std::optional<std::chrono::milliseconds> wait = pauses_.Next(error);
    if (is_last_ || !wait.has_value() || Clock::now() + *wait >= deadline_) return error;
    pause_(*wait, stop_);
    if (!stop_.stop_requested()) return std::nullopt;
    return absl::CancelledError("cancelled while waiting to try again");
  }

  const RetryPolicy policy_;
  const Pause& pause_;
  const std::stop_token stop_;
  const Clock::time_point deadline_;
  RetryPauses pauses_;
  bool is_last_ = false;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_RETRY_LOOP_H_
