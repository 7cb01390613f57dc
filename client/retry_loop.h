#ifndef BCCSKEL_CLIENT_RETRY_LOOP_H_
#define BCCSKEL_CLIENT_RETRY_LOOP_H_

#include <chrono>
#include <functional>
#include <optional>
#include <stop_token>
#include <utility>

#include "absl/status/status.h"
#include "client/retry_policy.h"

namespace bccskel::client {

// How a retrying connection waits between attempts; tests replace it.
using Pause = std::function<void(std::chrono::milliseconds, const std::stop_token&)>;

// The attempts at one call. They share one deadline; a pause that would exceed it is not begun.
// Threads: one at a time.
class RetryLoop {
 public:
  using Clock = std::chrono::system_clock;

  // Needs: `pause` outlives the loop.
  RetryLoop(const RetryPolicy& policy, const Pause& pause, std::chrono::milliseconds timeout,
            std::stop_token stop)
      : policy_(policy),
        pause_(pause),
        stop_(std::move(stop)),
        deadline_(Clock::now() + timeout),
        pauses_(policy) {}

  Clock::time_point deadline() const { return deadline_; }

  // Pauses and yields nullopt if the call should be tried again after this error; else yields the
  // call's final status.
  std::optional<absl::Status> EndAfter(const absl::Status& error) {
    const std::optional<std::chrono::milliseconds> wait = pauses_.Next(error);
    if (!wait.has_value() || Clock::now() + *wait >= deadline_) return error;
    pause_(*wait, stop_);
    if (!stop_.stop_requested()) return std::nullopt;
    return absl::CancelledError("cancelled while waiting to try again");
  }

  // The attempt made progress: resets the pauses and the count of attempts.
  void Progressed() { pauses_ = RetryPauses(policy_); }

 private:
  const RetryPolicy policy_;
  const Pause& pause_;
  const std::stop_token stop_;
  const Clock::time_point deadline_;
  RetryPauses pauses_;
};

}  // namespace bccskel::client

#endif  // BCCSKEL_CLIENT_RETRY_LOOP_H_
