#ifndef BCCSKEL_SERVER_STORE_GROUP_COMMIT_H_
#define BCCSKEL_SERVER_STORE_GROUP_COMMIT_H_

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <stop_token>
#include <thread>
#include <utility>
#include <vector>

#include "absl/status/status.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"

namespace bccskel::server {

// The only thread that uses a job store. Changes that arrive while a transaction is written share
// the next one, so that the rate of changes is not limited by that of disk flushes.
// Threads: safe.
class GroupCommit {
 public:
  // Runs within the shared transaction. An error rolls back this change only. If the transaction
  // fails, the change runs again in a smaller one; it must then overwrite all results of the first
  // run.
  using Change = std::function<absl::Status(JobStore& store)>;
  // Runs after the transaction is on disk, with the error of the change or of the transaction.
  using Done = std::function<void(absl::Status)>;

  // The space that a change may use when the disk is full.
  enum class Room { kFree, kReserve };

  // Holds the reserve, if any, from now on.
  explicit GroupCommit(std::unique_ptr<JobStore> store,
                       std::unique_ptr<DiskReserve> reserve = nullptr);
  ~GroupCommit();  // runs what was posted, and what that posts, then joins
  GroupCommit(const GroupCommit&) = delete;
  GroupCommit& operator=(const GroupCommit&) = delete;
  // `task` runs at the beginning of each transaction, before its changes: the store is then as all
  // other servers have left it, and none of them changes it. Needs: nothing was posted yet.
  void OnBegin(std::function<void()> task) { on_begin_ = std::move(task); }

  // Changes and their `done` run in the order of posting. Neither may throw or block for long.
  // kReserve is for what frees space or ends a job.
  void Post(Change change, Done done, Room room = Room::kFree);
  // Runs `task` without a change.
  void Post(std::function<void()> task);
  // Needs: called within a change or its `done`.
  JobStore& store() { return *store_; }

  // Not OK when changes cannot be stored or data may have been read wrongly. A full disk is OK.
  absl::Status Health() const;

 private:
  struct Entry {
    Change change;  // null: none
    Done done;
    Room room = Room::kFree;
    absl::Status status = absl::OkStatus();

    bool IsToWrite() const { return change != nullptr && status.ok(); }
  };

  void Serve(std::stop_token stop);
  void Write(std::span<Entry> batch);
  absl::Status WriteWithReserve(std::span<Entry> batch);
  void NoteHealth(const absl::Status& written);
  absl::Status WriteAll(std::span<Entry> batch);
  enum class Steps { kNone, kEach };  // that can be rolled back individually
  absl::Status WriteOnce(std::span<Entry> batch, Steps steps);
  absl::Status RunStep(Entry& entry);
  absl::Status RunWithoutStep(Entry& entry);

  const std::unique_ptr<JobStore> store_;
  std::function<void()> on_begin_;
  const std::unique_ptr<DiskReserve> reserve_;  // may be null
  mutable std::mutex mutex_;
  std::condition_variable_any wake_;
  absl::Status failure_;        // guarded by mutex_: of the last transaction
  std::vector<Entry> waiting_;  // guarded by mutex_
  std::jthread thread_;         // last: joined before the rest is destroyed
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_STORE_GROUP_COMMIT_H_
