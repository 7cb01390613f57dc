#ifndef BCCSKEL_SERVER_DURABLE_JOB_JOURNAL_H_
#define BCCSKEL_SERVER_DURABLE_JOB_JOURNAL_H_

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/store/job_store.h"

namespace bccskel::server {

// Crashes of the server that one job may survive; with the next one it has FAILED.
inline constexpr int kCrashesToPoison = 3;

// A job's new state, and the event that tells it; none where nothing has happened to the job.
struct Step {
  JobRow job;
  std::optional<EventRow> event = std::nullopt;
};

// The only place where jobs change their states: the row, and an event that tells it.
// Threads: one at a time, the store's.
class JobJournal {
 public:
  // `owner`: this process, among all that ever owned the store.
  JobJournal(std::string owner, std::function<Time()> now)
      : owner_(std::move(owner)), now_(std::move(now)) {}

  // Stores a new job in its state.
  absl::StatusOr<Step> Insert(JobStore& store, JobRow job);

  // Brings the job into the state and stores it with all else that `job` says. Entering kRunning
  // counts an attempt. Nothing happens when the stored job has ended already.
  // Needs: `job` as it was found in the same transaction.
  absl::StatusOr<Step> Enter(JobStore& store, JobRow job, JobState state,
                             absl::Status error = absl::OkStatus()) {
    return Enter(store, std::move(job), state, std::move(error), std::nullopt);
  }
  // The same for a job as it was stored some time ago; what is stored now is looked at where it has
  // changed since. Nothing happens, and nothing is yielded, unless the stored job `may` enter.
  using May = std::function<bool(const JobRow& job)>;
  absl::StatusOr<std::optional<Step>> EnterRemembered(JobStore& store, const JobRow& remembered,
                                                      JobState state, const absl::Status& error,
                                                      int64_t result, const May& may);

  // After a crash: a job that ran waits again, or has failed when it was there too often. Its
  // sequence leaps over what was told and not stored.
  absl::StatusOr<Step> RecoverRunning(JobStore& store, JobRow job);

  // The next number of an event, stored or not.
  uint64_t NextSequence(int64_t job, uint64_t stored);
  void Forget(int64_t job) { sequences_.erase(job); }

  const std::string& owner() const { return owner_; }
  void SetOwner(std::string owner) { owner_ = std::move(owner); }

 private:
  // Only where the stored job has the sequence `from`, if any.
  absl::StatusOr<Step> Enter(JobStore& store, JobRow job, JobState state, absl::Status error,
                             std::optional<uint64_t> from);
  static absl::StatusOr<Step> AddEvent(JobStore& store, JobRow job, Time time);

  std::string owner_;
  const std::function<Time()> now_;
  std::map<int64_t, uint64_t> sequences_;  // the last one of each unfinished job
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_JOB_JOURNAL_H_
