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

// A job that waits. One that ran while the server crashed may be the reason: it is a suspect.
struct WaitingJob {
  int64_t job = 0;
  bool suspect = false;
};
using JobQueue = FairQueue<WaitingJob, std::chrono::system_clock>;
// An unfinished job. Its row is what the store has.
struct ActiveJob {
  JobRow row;
  Run* run = nullptr;                    // that computes it, or decodes its volume while it comes
  std::optional<JobQueue::Entry> place;  // in the queue
};
// A computation. Jobs that want the same share it.
struct ActiveRun {
  enum class Source { kUpload, kFile };
  std::shared_ptr<Run> run;
  Source source = Source::kFile;
  std::string tenant;
  std::string options;
  std::string volume;         // its name; empty while it is received
  std::string volume_digest;  // empty until it is decoded
  std::set<int64_t> jobs;
  int crashes = 0;                 // of the server, of the job that it was begun for
  bool ending = false;             // nobody joins any more
  RunPace::Clock::time_point fed;  // when it was given its volume
  bool computed = false;           // its result is being written
};

// What is remembered of unfinished jobs, as of a moment ago: their rows, the runs that compute them
// here, and who is next. Nothing here looks into the store.
// Threads: one at a time, but for Count().
class ActiveJobs {
 public:
  // `shared`: other servers run jobs, too.
  // `soon`: as of RunPace.
  ActiveJobs(bool shared, std::chrono::milliseconds soon) : shared_(shared), pace_(soon) {}

  // ---- Jobs
  size_t size() const { return jobs_.size(); }
  int Count(JobState state) const { return in_state_[static_cast<size_t>(state)]; }
  const std::map<int64_t, ActiveJob>& jobs() const { return jobs_; }
  ActiveJob* Find(int64_t job);  // null: none
  // As it is stored now; out of the queue.
  ActiveJob& Put(const JobRow& row);
  void Forget(int64_t job);

  // ---- Runs
  ActiveRun& AddRun(std::shared_ptr<Run> run, const JobRow& job, ActiveRun::Source source);
  ActiveRun* FindRun(const Run* run);   // null: nobody wants it any more
  ActiveRun* FindOpen(const Run* run);  // the same, and where it is ending
  // One that others may join, of the same options and volume.
  ActiveRun* FindEqual(const JobRow& job, const VolumeRow& volume);
  ActiveRun* FindEqual(const ActiveRun& run);
  void Attach(ActiveRun& run, int64_t job);
  // Who is the last to leave a run cancels it.
  void Detach(int64_t job);
  void ForgetRun(const Run* run);
  void CancelRuns();
  void ForgetRuns();  // cancels them, too
  // The run's place is free while its result is written and stored.
  void Computed(ActiveRun& run);

  // ---- Whose turn it is
  void Enqueue(ActiveJob& job);
  // Not before QueueWaiting(): an equal one runs elsewhere.
  void WaitForEqual(ActiveJob& job);
  void QueueWaiting();
  struct Turn {
    JobRow job;
    bool ahead = false;  // of a place: see RunPace
  };
  // Whether TakeNext() would give something.
  bool HasNext(const TenantTable& tenants, int max_runs);
  // Nothing where nobody waits, or there is no place now.
  std::optional<Turn> TakeNext(const TenantTable& tenants, int max_runs);
  // The job whose turn it was is not to be begun ahead: it is the next.
  void WaitForPlace(int64_t job) { next_ = job; }

 private:
  void Dequeue(ActiveJob& job);
  template <typename Which>
  int CountRunsFromFiles(Which which) const;
  std::map<std::string, int> RunsOfTenants() const;
  enum class Room { kNone, kAhead, kPlace };
  Room RoomFor(int max_runs) const;
  // Tells the queue how things are; what it may give now.
  auto MayBegin(const TenantTable& tenants);
  template <typename Volume>
  ActiveRun* FindJoinable(const std::string& tenant, const std::string& options, Volume is_equal);

  const bool shared_;
  std::map<int64_t, ActiveJob> jobs_;
  std::array<std::atomic<int>, 6> in_state_ = {};  // jobs, by JobState
  std::map<const Run*, ActiveRun> runs_;
  JobQueue queue_;
  RunPace pace_;
  std::optional<int64_t> next_;
  std::set<int64_t> waiting_for_equal_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_ACTIVE_JOBS_H_
