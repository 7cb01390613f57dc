#ifndef BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_
#define BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_

#include <set>
#include <string>
#include <utility>

#include "absl/status/status.h"
#include "absl/status/statusor.h"
#include "server/durable/durable_options.h"
#include "server/store/blob_store.h"
#include "server/store/data_folder.h"
#include "server/store/job_store.h"
#include "server/store/upload_file.h"

namespace bccskel::server {

// Which files of the data folder the tables name, and what becomes of the others: what is merely
// unknown stays for a day, and where something is missed it stays for good.
// Threads: one at a time, the store's, but for OldFiles().
class FolderFiles {
 public:
  FolderFiles(const DurableOptions& options, FolderLock lock)
      : options_(options), blobs_(options.data_directory), lock_(std::move(lock)) {}

  // Before a job store of its own is opened, which would make an empty one.
  static absl::Status CheckTables(const std::string& tables, const DurableOptions& options);

  // Who has the folder alone: takes over and sweeps what a process before this one has left.
  // Errors: FAILED_PRECONDITION for files that belong to another job store.
  absl::Status TakeOver(JobStore& store);
  // Who shares it: files that are not named may be others', made just now. Errors: as above.
  absl::Status Join(JobStore& store);
  // Files that were written before the last `keep_unknown`. Reads the folder.
  std::set<std::string> OldFiles() const;
  // Removes those of them that are not named.
  absl::Status Sweep(JobStore& store, const std::set<std::string>& old);
  // What a crash, or the file system, has left of deleted files.
  absl::Status RemoveDeleted(JobStore& store);
  // A sign of life for the next process.
  void Touch(Time now) { lock_.Touch(now); }

 private:
  // The paths of all files that the tables name, results that are not confirmed yet among them.
  absl::StatusOr<std::set<std::string>> Known(JobStore& store) const;
  void SweepAtStart(JobStore& store, const std::set<std::string>& files,
                    const std::set<std::string>& known) const;
  absl::Status Remove(JobStore& store, const RemovalRow& row) const;

  const DurableOptions& options_;
  const BlobStore blobs_;
  FolderLock lock_;
};

}  // namespace bccskel::server

#endif  // BCCSKEL_SERVER_DURABLE_FOLDER_FILES_H_
