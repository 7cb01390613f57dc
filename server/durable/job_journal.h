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

// A job during which the server has crashed this often has FAILED.
inline constexpr int kCrashesToPoison = 3;

// A job's new state and the event that reports it; no event if nothing has changed.
struct Step {
  JobRow job;
  std::optional<EventRow> event = std::nullopt;
};

// The only place that changes the state of a job: its row, and an event that reports it.
// Threads: one at a time, the store's.
class JobJournal {
 public:
  // `owner` identifies this process among all that ever owned the store.
  JobJournal(std::string owner, std::function<Time()> now)
      : owner_(std::move(owner)), now_(std::move(now)) {}

  // Stores a new job in its state.
  absl::StatusOr<Step> Insert(JobStore& store, JobRow job);

  // Enters the state and stores it with the other fields of `job`. Entering kRunning counts an
  // attempt. Does nothing if the stored job has ended already.
  // Needs: `job` as read in the same transaction.
  absl::StatusOr<Step> Enter(JobStore& store, JobRow job, JobState state,
                             absl::Status error = absl::OkStatus()) {
    return Enter(store, std::move(job), state, std::move(error), std::nullopt);
  }
  // The same for a job read some time ago; reads it again if it has changed since. Does nothing and
  // yields nullopt unless the stored job `may` enter.
  using May = std::function<bool(const JobRow& job)>;
  absl::StatusOr<std::optional<Step>> EnterRemembered(JobStore& store, const JobRow& remembered,
                                                      JobState state, const absl::Status& error,
                                                      int64_t result, const May& may);

  // After a crash: a job that was running waits again, or fails after too many crashes. Its
  // sequence skips numbers that may have been sent but not stored.
  absl::StatusOr<Step> RecoverRunning(JobStore& store, JobRow job);

  // The number of the next event, stored or not.
  uint64_t NextSequence(int64_t job, uint64_t stored);
  void Forget(int64_t job) { sequences_.erase(job); }

  const std::string& owner() const { return owner_; }
  void SetOwner(std::string owner) { owner_ = std::move(owner); }

 private:
  // Only if the stored job has the sequence `from`, if given.
  absl::StatusOr<Step> Enter(JobStore& store, JobRow job, JobState state, absl::Status error,
                             std::optional<uint64_t> from);
  static absl::StatusOr<Step> AddEvent(JobStore& store, JobRow job, Time time);

  std::string owner_;
  const std::function<Time()> now_;
  std::map<int64_t, uint64_t> sequences_;  // the last one of each unfinished job
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_JOB_JOURNAL_H_
