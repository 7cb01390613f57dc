#ifndef BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_
#define BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "server/durable/run.h"
#include "server/durable/run_pace.h"
#include "server/jobs/fair_queue.h"
#include "server/store/rows.h"

namespace bccskel::server {

inline JobPriority PriorityOf(const JobRow& job) {
  return static_cast<JobPriority>(std::clamp(job.priority, -1, 1));
}

// A waiting job. A job that was running when the server crashed may have caused the crash: it is a
// suspect.
struct WaitingJob {
  int64_t job = 0;
  bool suspect = false;
};
using JobQueue = FairQueue<WaitingJob, std::chrono::system_clock>;
// An unfinished job. Its row equals the stored one.
struct ActiveJob {
  JobRow row;
  Run* run = nullptr;  // that computes it, or decodes its volume during the upload
  std::optional<JobQueue::Entry> place;  // in the queue
};
// A computation. Equal jobs share it.
struct ActiveRun {
  enum class Source { kUpload, kFile };
  std::shared_ptr<Run> run;
  Source source = Source::kFile;
  std::string tenant;
  std::string options;
  std::string volume;         // its name; empty during the upload
  std::string volume_digest;  // empty until it is decoded
  std::set<int64_t> jobs;
  int crashes = 0;                 // of the server, of the job for which the run began
  bool ending = false;             // no further job may join
  RunPace::Clock::time_point fed;  // when it received its volume
  bool computed = false;           // its result is being written
};

// The unfinished jobs in memory, as of a moment ago: their rows, the runs that compute them here,
// and the queue. Nothing here reads the store.
// Threads: one at a time, except for Count().
class ActiveJobs {
 public:
  // `shared`: other servers run jobs, too. `soon` as in RunPace.
  ActiveJobs(bool shared, std::chrono::milliseconds soon) : shared_(shared), pace_(soon) {}

  // ---- Jobs
  size_t size() const { return jobs_.size(); }
  int Count(JobState state) const { return in_state_[static_cast<size_t>(state)]; }
  int CountOf(const std::string& tenant) const;
  const std::map<int64_t, ActiveJob>& jobs() const { return jobs_; }
  ActiveJob* Find(int64_t job);  // null: none
  // Adds or replaces the job with its stored row, and takes it out of the queue.
  ActiveJob& Put(const JobRow& row);
  void Forget(int64_t job);

  // ---- Runs
  ActiveRun& AddRun(std::shared_ptr<Run> run, const JobRow& job, ActiveRun::Source source);
  ActiveRun* FindRun(const Run* run);   // null: no job needs it any more
  ActiveRun* FindOpen(const Run* run);  // the same; null also for an ending run
  // A run of the same options and volume that the job may join.
  ActiveRun* FindEqual(const JobRow& job, const VolumeRow& volume);
  ActiveRun* FindEqual(const ActiveRun& run);
  void Attach(ActiveRun& run, int64_t job);
  // The last job to leave a run cancels it.
  void Detach(int64_t job);
  void ForgetRun(const Run* run);
  void CancelRuns();
  void ForgetRuns();  // also cancels them
  // The run is computed: its place is free while its result is written and stored.
  void Computed(ActiveRun& run);

  // ---- Whose turn it is
  void Enqueue(ActiveJob& job);
  // Keeps the job out of the queue until QueueWaiting(), because another server runs an equal one.
  void WaitForEqual(ActiveJob& job);
  void QueueWaiting();
  struct Turn {
    JobRow job;
    bool ahead = false;  // begun before a place is free: see RunPace
  };
  // Whether TakeNext() would yield a job.
  bool HasNext(const TenantTable& tenants, int max_runs);
  // Whether jobs wait. The passing of time alone may let one of them begin.
  bool HasWaiting() const { return !queue_.empty(); }
  // nullopt if no job waits or there is no place now.
  std::optional<Turn> TakeNext(const TenantTable& tenants, int max_runs);
  // Puts a job that must not begin ahead back at the front.
  void WaitForPlace(int64_t job) { next_ = job; }

 private:
  void Dequeue(ActiveJob& job);
  template <typename Which>
  int CountRunsFromFiles(Which which) const;
  std::map<std::string, int> RunsOfTenants() const;
  // kTurn: all places have been held for long, but a tenant that has none of them may begin a job.
  enum class Room { kNone, kTurn, kAhead, kPlace };
  Room RoomFor(int max_runs) const;
  // Updates the queue's limits; yields the condition for a job to begin now.
  auto MayBegin(const TenantTable& tenants, Room room);
  template <typename Volume>
  ActiveRun* FindJoinable(const std::string& tenant, const std::string& options, Volume is_equal);

  const bool shared_;
  std::map<int64_t, ActiveJob> jobs_;
  std::array<std::atomic<int>, 6> in_state_ = {};  // jobs, by JobState
  std::map<std::string, int> of_tenant_;           // jobs, by tenant
  std::map<const Run*, ActiveRun> runs_;
  JobQueue queue_;
  RunPace pace_;
  std::optional<int64_t> next_;
  std::set<int64_t> waiting_for_equal_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_
