#ifndef BCCSKEL_SERVER_CALLS_EVENT_QUEUE_H_
#define BCCSKEL_SERVER_CALLS_EVENT_QUEUE_H_

#include <deque>
#include <optional>
#include <utility>

#include "bccskel/v1/job_service.pb.h"

namespace bccskel::server {

// Events that a caller has not read yet, in order. Between two state changes it keeps only the
// newest progress, so a slow reader costs bounded memory: a job has a handful of states.
class EventQueue {
 public:
  void Add(v1::WatchJobResponse event) {
    if (event.has_shell_progress() && !events_.empty() && events_.back().has_shell_progress()) {
      events_.pop_back();
    }
    sequence_ = event.sequence();
    events_.push_back(std::move(event));
  }

  std::optional<v1::WatchJobResponse> Next() {
    if (events_.empty()) return std::nullopt;
    v1::WatchJobResponse event = std::move(events_.front());
    events_.pop_front();
    return event;
  }

  // The number of the newest event, or the start set by StartAfter().
  uint64_t sequence() const { return sequence_; }
  void StartAfter(uint64_t sequence) { sequence_ = sequence; }

 private:
  std::deque<v1::WatchJobResponse> events_;
  uint64_t sequence_ = 0;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_CALLS_EVENT_QUEUE_H_
