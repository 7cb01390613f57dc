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

// Hears of a job. Called on DurableJobs' thread; must not block.
class JobWatcher {
 public:
  virtual ~JobWatcher() = default;
  // In order of sequence. State changes are lossless; of shells only the newest is told.
  virtual void OnEvent(const JobEvent& event) = 0;
  // Once, last: OK after the completed event; NOT_FOUND; UNAVAILABLE when the server stops.
  virtual void OnWatchEnd(const absl::Status& status) = 0;
};

// One watcher of one job. Threads: Stop() and over() from any, the rest from DurableJobs'.
class Watch {
 public:
  Watch(uint64_t after_sequence, std::shared_ptr<JobWatcher> watcher)
      : told_(after_sequence), watcher_(std::move(watcher)) {}

  // Leaves out what was told already, but for the end: no watch ends without it.
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
  // No call of the watcher begins after that.
  void Stop() { stopped_ = true; }
  bool over() const { return stopped_ || watcher_ == nullptr; }

 private:
  uint64_t told_;                        // the last sequence
  std::shared_ptr<JobWatcher> watcher_;  // null once it was told the end
  std::atomic<bool> stopped_ = false;
};

// Who watches which unfinished job, and the newest progress of each.
// Threads: one at a time, DurableJobs'.
class WatchBoard {
 public:
  void Add(int64_t job, std::shared_ptr<Watch> watch);
  // After a completed event the job's watches are over.
  void Tell(int64_t job, const JobEvent& event);
  bool Has(int64_t job) const { return watches_.contains(job); }
  // Newest progress of a running job.
  std::optional<JobProgress> ProgressOf(int64_t job) const;
  void End(int64_t job, const absl::Status& status);
  void EndAll(const absl::Status& status);

 private:
  std::map<int64_t, std::vector<std::shared_ptr<Watch>>> watches_;
  std::map<int64_t, JobEvent> progress_;
};

JobEvent EventOf(const EventRow& row);

// Progress as servers of a fleet tell it each other, and back; nothing for what is none.
std::string BytesOf(const JobProgress& progress);
std::optional<JobProgress> ProgressOfBytes(const std::string& bytes);

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_WATCH_BOARD_H_
