#ifndef BCCSKEL_SERVER_STORE_GROUP_COMMIT_H_
#define BCCSKEL_SERVER_STORE_GROUP_COMMIT_H_

#include <atomic>
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

// The one thread that touches a job store. What waits while a transaction is written shares the
// next one, so that the number of changes a second is not that of the disk's flushes.
// Threads: safe.
class GroupCommit {
 public:
  // Runs within the shared transaction. An error takes back what it did, and nothing else. Runs
  // again, in a smaller transaction, where the shared one fails: what it told its end before is
  // void.
  using Change = std::function<absl::Status(JobStore& store)>;
  // Runs after the transaction is on disk, with the change's error, or that of the transaction.
  using Done = std::function<void(absl::Status)>;

  // What a change may write to when the disk is full.
  enum class Room { kFree, kReserve };

  // The reserve, if any, is held from now on.
  explicit GroupCommit(std::unique_ptr<JobStore> store,
                       std::unique_ptr<DiskReserve> reserve = nullptr);
  ~GroupCommit();  // does what was posted, also by what it does, then joins
  GroupCommit(const GroupCommit&) = delete;
  GroupCommit& operator=(const GroupCommit&) = delete;
  // Called from now on when a transaction has begun, before its changes: then the store is as all
  // others have left it, and nobody changes it. Needs: nothing was posted yet.
  void OnBegin(std::function<void()> task) { on_begin_ = std::move(task); }

  // Changes and their ends come in the order of posting. Neither may throw or block for long.
  // kReserve is for what makes room, or ends a job.
  void Post(Change change, Done done, Room room = Room::kFree);
  // Without a change.
  void Post(std::function<void()> task);
  // Needs: called from within a change or its end.
  JobStore& store() { return *store_; }

  // Why what is posted cannot be stored, or may have been read wrongly; OK else. A full disk is no
  // illness.
  absl::Status Health() const;

  uint64_t commits() const { return commits_; }

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
  enum class Steps { kNone, kEach };  // that can be taken back alone
  absl::Status WriteOnce(std::span<Entry> batch, Steps steps);
  absl::Status RunStep(Entry& entry);
  absl::Status RunWithoutStep(Entry& entry);

  const std::unique_ptr<JobStore> store_;
  std::atomic<uint64_t> commits_ = 0;
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
