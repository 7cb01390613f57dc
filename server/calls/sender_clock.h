#ifndef BCCSKEL_SERVER_CALLS_SENDER_CLOCK_H_
#define BCCSKEL_SERVER_CALLS_SENDER_CLOCK_H_

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>

#include "absl/status/status.h"
#include "absl/strings/str_cat.h"
#include "server/errors/call_error.h"

namespace bccskel::server {

// How long callers may take; 0: no limit.
struct CallerTimeouts {
  std::chrono::milliseconds sender{60'000};   // for the next 1 MiB of a volume
  std::chrono::milliseconds reader{600'000};  // for the next response
};

// Counts the time that the server waits for the next request of a caller who sends a volume. Within
// the limit the caller must send kBytesInTime or the rest. Time in which the server processes a
// request does not count.
// Threads: one at a time.
class SenderClock {
 public:
  using TimePoint = std::chrono::steady_clock::time_point;
  static constexpr uint64_t kBytesInTime = uint64_t{1} << 20;

  // The server begins to wait.
  void Await(TimePoint now) { waiting_since_ = now; }

  // A request with this many bytes of the volume has arrived.
  void Take(TimePoint now, uint64_t bytes) {
    waited_ = Waited(now);
    waiting_since_.reset();
    bytes_ += bytes;
    if (bytes_ < kBytesInTime) return;
    waited_ = {};
    bytes_ = 0;
  }

  // Errors: ABORTED, reason SENDER_TIMEOUT.
  absl::Status Check(TimePoint now, std::chrono::milliseconds limit) const {
    const bool waits = limit.count() > 0 && waiting_since_.has_value();  // 0: no limit
    if (!waits || Waited(now) <= limit) return absl::OkStatus();
    const std::string ms = absl::StrCat(limit.count());
    return CallError(
        Reason::kSenderTimeout,
        absl::StrCat("the server has waited more than ", ms, " ms for the volume; within each ", ms,
                     " ms (sender-timeout-ms) send ", kBytesInTime,
                     " bytes or the rest and the finish"),
        {.key = "sender_timeout_ms", .value = ms});
  }

 private:
  std::chrono::nanoseconds Waited(TimePoint now) const {
    return waiting_since_.has_value() ? waited_ + (now - *waiting_since_) : waited_;
  }

  std::optional<TimePoint> waiting_since_;
  std::chrono::nanoseconds waited_{0};
  uint64_t bytes_ = 0;  // since waited_ was last reset
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_SENDER_CLOCK_H_
