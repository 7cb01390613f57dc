#ifndef BCCSKEL_SERVER_DURABLE_WATCH_BOARD_H_
#define BCCSKEL_SERVER_DURABLE_WATCH_BOARD_H_

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "server/durable/records.h"
#include "server/store/rows.h"

namespace bccskel::server {

// Receives the events of a job. Called on DurableJobs' thread; must not block.
class JobWatcher {
 public:
  virtual ~JobWatcher() = default;
  // In order of sequence. No state change is skipped; of progress only the newest is reported.
  virtual void OnEvent(const JobEvent& event) = 0;
  // Called once, last: OK after the completed event; NOT_FOUND; UNAVAILABLE when the server stops.
  virtual void OnWatchEnd(const absl::Status& status) = 0;
};

// One watcher of one job. Threads: Stop() and over() from any, the rest from DurableJobs'.
class Watch {
 public:
  Watch(uint64_t after_sequence, std::shared_ptr<JobWatcher> watcher)
      : told_(after_sequence), watcher_(std::move(watcher)) {}

  // Skips events already delivered, except for the completed event, without which no watch ends.
  void Tell(const JobEvent& event) {
    if (over() || (event.sequence <= told_ && !event.IsCompleted())) return;
    told_ = event.sequence;
    watcher_->OnEvent(event);
    if (event.IsCompleted()) End(absl::OkStatus());
  }
  void End(const absl::Status& status) {
    if (over()) return;
    const std::shared_ptr<JobWatcher> watcher = std::move(watcher_);
    watcher->OnWatchEnd(status);
  }
  // No call to the watcher begins after this.
  void Stop() { stopped_ = true; }
  bool over() const { return stopped_ || watcher_ == nullptr; }

 private:
  uint64_t told_;                        // the last sequence delivered
  std::shared_ptr<JobWatcher> watcher_;  // null after OnWatchEnd()
  std::atomic<bool> stopped_ = false;
};

// The watches of unfinished jobs, and the newest progress of each.
// Threads: one at a time, DurableJobs'.
class WatchBoard {
 public:
  void Add(int64_t job, std::shared_ptr<Watch> watch);
  // A completed event ends the job's watches.
  void Tell(int64_t job, const JobEvent& event);
  bool Has(int64_t job) const { return watches_.contains(job); }
  // The newest progress of a running job.
  std::optional<JobProgress> ProgressOf(int64_t job) const;
  void End(int64_t job, const absl::Status& status);
  void EndAll(const absl::Status& status);

 private:
  std::map<int64_t, std::vector<std::shared_ptr<Watch>>> watches_;
  std::map<int64_t, JobEvent> progress_;
};

JobEvent EventOf(const EventRow& row);

// Progress in the form that servers of a fleet exchange, and back; nullopt for malformed bytes.
std::string BytesOf(const JobProgress& progress);
std::optional<JobProgress> ProgressOfBytes(const std::string& bytes);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_WATCH_BOARD_H_
